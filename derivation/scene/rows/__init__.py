"""Simulation of many scenes at once, in arrays with a row for each."""
