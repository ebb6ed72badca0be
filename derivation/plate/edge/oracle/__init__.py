"""Arb references for the edge, from the original expressions."""
