"""Elastic-plastic contact: limited pressure, elastic unloading, residual indentation."""
