"""Text of the report about stretching, by derivation step."""

ABOUT = {
    "stretching": "A plate that deflects by a fraction of its thickness stretches its middle plane "
    "and becomes stiffer. The contact law neglects this; to first order the stiffening is $A "
    "w^2/H^2$. It is part of the model error that a simulation states.",
}
