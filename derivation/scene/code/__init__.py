"""Generated code of one scene."""
