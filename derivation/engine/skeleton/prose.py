"""Text of the report."""

TITLE = "A film on a rigid base"
SUBTITLE = "Derivation, misprints, accuracy"
ABSTRACT = (
    "A film of thickness $H$ lies on a rigid base, bonded or free to slip, and a pressure "
    "$p J_0(k r)$ acts on it. How large is the deflection of its surface, and how accurately can "
    "it be computed?"
)
ABOUT = {
    "film": "Navier's equations leave four constants; two conditions at the base and two on top "
    "determine them.",
}
"""Text about each step, by its name."""
