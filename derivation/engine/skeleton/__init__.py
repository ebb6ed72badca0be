"""A small working paper to start from: an elastic film on a rigid base, pressure p J0(k r)."""
