"""Reference values by another method, in mpmath: plates with a held edge."""
