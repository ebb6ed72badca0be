"""One mode of the plate through its thickness, and sums over the modes."""
