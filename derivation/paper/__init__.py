"""The equations as printed, held against the derived ones; what is wrong, and what mends it."""
