"""Changes of the contact law by single effects, and the parameters that show when they matter."""
