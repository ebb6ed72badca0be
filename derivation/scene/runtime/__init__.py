"""Plain modules that the code of a scene is put together from, and the numbers they need."""
