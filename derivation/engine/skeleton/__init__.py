"""A small paper to begin with: an elastic film on a rigid base, pressed by p J0(k r)."""
