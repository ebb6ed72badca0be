"""The impact: the sphere's motion, its results and their sensitivities."""
