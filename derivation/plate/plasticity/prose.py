"""Text of the report about elastic-plastic contact, by derivation step."""

ABOUT = {
    "plasticity": "In the model of Thornton (1997) the pressure cannot exceed $1.6 Y$, where "
    "$Y$ is the smaller yield stress of the two bodies. Beyond the contact radius $a_y$ the "
    "pressure is Hertz's where that is below the limit, and constant inside. Unloading is elastic, "
    "by Hertz's law with the flattened radius, and leaves a residual indentation.",
}
