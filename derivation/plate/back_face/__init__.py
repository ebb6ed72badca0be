"""The stress on the back face, opposite the contact."""
