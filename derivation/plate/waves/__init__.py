"""The plate's inertia: Lamb waves, bending, and the impact's coupling to them."""
