"""J0, J1, I0 and I1: expansions, phases and zeros, with bounds."""
