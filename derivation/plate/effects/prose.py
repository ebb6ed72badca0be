"""Text of the report about single effects, by derivation step."""

ABOUT = {
    "effects": "Each effect contributes to the slope of the contact law at equal force. An "
    "upper bound on its contribution decides whether a scene requires the effect.",
}
