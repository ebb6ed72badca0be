"""Plain modules that every generated package starts with, copied as they stand."""
