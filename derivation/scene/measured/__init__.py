"""Material constants from a measured restitution."""
