"""Text of the report about stretching, by derivation step."""

ABOUT = {
    "stretching": "A plate that deflects by a fraction of its thickness stretches its middle plane "
    "and becomes stiffer. The contact law neglects this; to first order the stiffening is $A "
    "w^2/H^2$. The tension of the middle plane on the axis is $B w/H$ times $3 (1 + \\nu) "
    "P/(2 \\pi H^2)$. Both are parts of the model errors that a simulation states.",
}
