"""Modes and waves of plates with a clamped or simply supported edge."""
