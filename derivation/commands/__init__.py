"""The command line's commands; each makes one call and shows its result."""
