"""The exception of a failed check; its message states which, and the residual."""


class FailedError(AssertionError):
    """A proof fails, or two references contradict each other."""
