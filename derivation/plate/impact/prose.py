"""What the report says of impacts, by link."""

ABOUT = {
    "impact": "The energy integral, the contact time as an integral of an analytic function, and "
    "the paper's linearisation.",
    "sensitivity": "An impact depends on seven parameters through two numbers, its energy "
    "number and $h/b$, beside plain powers. What these two do to peaks and "
    "contact time follows from the energy integral; the rest is exponents.",
    "substitution": "If the law's slope lies within known factors of a simpler one's, so do an "
    "impact's results. It lies between $S_1 = 1 + 3 c_1 A/2$ and "
    "$S_1 - K_3 A^3$ for every $a < b$, so that Hertz's law, and its first "
    "correction, know their own error.",
}
