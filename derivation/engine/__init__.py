"""The engine: what is done with a paper, whatever it is about."""
