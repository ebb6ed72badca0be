"""Which expressions become code, and the numbers that this code needs: the static contact."""
