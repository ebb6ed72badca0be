"""Text of the report about single effects, by derivation step."""

ABOUT = {
    "effects": "Each effect contributes to the slope of the law at equal force. An upper bound of "
    "its contribution decides whether a scene needs it.",
}
