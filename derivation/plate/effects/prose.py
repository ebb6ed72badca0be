"""What the report says of single effects, by link."""

ABOUT = {
    "effects": "Each effect adds a share to the law's slope at equal force. What it can add at "
    "most says whether a scene needs it.",
}
