"""The contact law of a scene: its parts, their errors, and yield."""
