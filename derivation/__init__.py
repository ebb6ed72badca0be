"""platecontact: derive, correct and stabilise the contact law of a sphere on a plate."""

import os

# python-flint would silently become SymPy's ground types and change printed forms.
os.environ["SYMPY_GROUND_TYPES"] = "python"
