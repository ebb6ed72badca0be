"""Algorithms of the elastic-plastic contact, copied into the generated package."""
