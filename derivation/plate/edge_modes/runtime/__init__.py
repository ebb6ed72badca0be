"""Algorithms of the modes of plates with a held edge, copied into the generated package."""
