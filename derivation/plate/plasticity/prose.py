"""What the report says of contacts that yield, by link."""

ABOUT = {
    "plasticity": "In a contact that yields (Thornton 1997) the pressure cannot exceed $1.6 Y$, "
    "$Y$ the yield stress of the softer body: from the contact radius $a_y$ on, the pressure "
    "is Hertz's where that is below the limit, and constant inside. Unloading is elastic, by "
    "Hertz's law with the flattened radius, and leaves a dent.",
}
