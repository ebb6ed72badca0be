"""Same value, other shape: forms of the derived formulas that floating point can evaluate.

Every form is proved equal to the formula it stands for before it leaves this room.
"""
