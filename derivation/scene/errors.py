"""What a scene fails with: one message with key, expectation, value and remedy."""


class SceneError(ValueError):
    """A scene that cannot be computed: the one way in which `scene` fails.

    The message gives the key, what was expected, the value, and the remedy.
    """


class IncompleteError(SceneError):
    """An impact with plate inertia that could not be followed to its end: why, and the remedy."""

    def __init__(self, why: str, remedy: str) -> None:
        super().__init__(why, remedy)  # as pickle makes it anew
        self.why, self.remedy = why, remedy

    def __str__(self) -> str:
        return f"effects.inertia: {self.why}; {self.remedy}"
