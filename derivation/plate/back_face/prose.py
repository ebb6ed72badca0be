"""What the report says of the back face, by link."""

ABOUT = {
    "far face": "A plate breaks where it is drawn most: on the far face, under the axis. What its "
    "modes add up to there is, of a thin plate, a function of a/h and a logarithm of b/h; the "
    "edge's states of stretching and bending add their own stress.",
}
