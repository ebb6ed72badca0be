"""Reference values in ball arithmetic, from the original expressions: plates with a held edge."""
