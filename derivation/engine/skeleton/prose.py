"""Text of the report."""

TITLE = "A film on a rigid base"
SUBTITLE = "Derivation, misprints, accuracy"
ABSTRACT = (
    "A film of thickness $H$ lies on a rigid base, bonded or free to slip, and a pressure "
    "$p J_0(k r)$ acts on it. How far does its surface yield, and what is lost when that is "
    "computed?"
)
ABOUT = {
    "film": "Navier's equations leave four constants; two conditions at the base and two on top "
    "determine them.",
}
"""Text by the name of the link."""
