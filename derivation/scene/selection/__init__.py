"""Selection of effects and methods by bounds on the change of the results."""
