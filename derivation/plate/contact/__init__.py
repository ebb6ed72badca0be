"""The static contact: force, indentation and contact radius."""
