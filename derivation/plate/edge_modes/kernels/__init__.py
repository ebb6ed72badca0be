"""Which expressions become code, and the numbers that this code needs: plates with a held edge."""
