"""The algorithms of the modes: sums over them."""
