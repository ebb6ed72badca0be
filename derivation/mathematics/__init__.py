"""Mathematics that is independent of any paper."""
