"""The base class of exceptions for failed proofs and contradicting references."""


class FailedError(AssertionError):
    """A proof fails, or two references contradict each other."""
