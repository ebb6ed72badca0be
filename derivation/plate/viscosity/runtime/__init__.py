"""The viscous contact in NumPy, copied into the generated package."""
