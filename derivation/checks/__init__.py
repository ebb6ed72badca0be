"""Checks of simulations: on random scenes, and against finite elements and other references."""
