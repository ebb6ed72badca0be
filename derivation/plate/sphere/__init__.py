"""The finite size of an elastic sphere, and the motion of the faces in a contact."""
