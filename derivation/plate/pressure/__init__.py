"""The non-Hertzian contact pressure, from its integral equation."""
