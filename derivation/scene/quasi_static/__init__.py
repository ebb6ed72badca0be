"""Impacts on a quasi-static plate: elastic, viscoelastic and plastic contacts."""
