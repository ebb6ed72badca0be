"""Text of the report about finite spheres, by derivation step."""

ABOUT = {
    "finite sphere": "The contact law treats an elastic sphere as a half-space. Its compliance for "
    "each Legendre polynomial gives the change of the indentation by its finite size, to first "
    "order in $a/R$: a logarithm and a constant, which is a sum. The motion of both faces towards "
    "the axis is of the same order. A simulation states both as parts of its model errors.",
}
