"""Impacts on a plate with inertia: modes, time elements, contacts and flights, results."""
