"""Arb references for clamped and supported plates, from the original expressions."""
