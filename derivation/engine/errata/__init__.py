"""The published equations compared with the derived ones: misprints and their corrections."""
