"""Modules common to all generated packages, copied without change."""
