"""Plain modules from which the code of a scene is assembled, and their constants."""
