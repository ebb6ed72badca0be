"""The tables and keys of a scene file: checks, materials, messages, old names."""
