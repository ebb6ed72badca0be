"""The contact that yields: limited pressure on loading, elastic unloading, and a dent."""
