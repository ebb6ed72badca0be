"""Stable forms: expressions equal to the derived formulas that suit floating-point arithmetic.

Every form is proved equal to its formula before another subpackage uses it.
"""
