"""A small paper as a start: an elastic film on a rigid base under the pressure p J0(k r)."""
