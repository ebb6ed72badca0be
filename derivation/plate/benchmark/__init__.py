"""What accuracy costs in time: every method's digits and seconds, side by side."""
