"""What a check raises that fails: the message says which, and what is left over."""


class FailedError(AssertionError):
    """A proof does not hold, or two references contradict each other."""
