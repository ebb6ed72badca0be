"""Benchmark of all methods: correct digits and run time of each."""
