"""Algorithms of the contact law, copied into the generated package."""
