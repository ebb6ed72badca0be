"""Checks of error bounds and effect selection on random scenes, and against finite elements."""
