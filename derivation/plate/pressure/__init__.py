"""The contact pressure from its integral equation instead of Hertz's."""
