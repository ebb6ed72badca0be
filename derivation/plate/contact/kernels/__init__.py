"""Which expressions become code, and the numbers that this code needs: the static contact."""

from derivation.plate.contact.kernels import moments

MODULES = moments.MODULES
