"""The edge of the plate: simply supported or clamped."""
