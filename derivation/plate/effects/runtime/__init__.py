"""Public functions of the effects, copied into the generated package."""
