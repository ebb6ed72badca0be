"""Commands of the command line; each makes one call and shows the result."""
