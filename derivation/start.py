"""The entry point of the command, so that Ctrl-C while its modules load gives one message, too."""

import gc
import sys

ALLOCATIONS = 100_000
"""Number of new objects after which Python looks for unreachable ones: modules have many objects
that stay, and simulations few."""


def main() -> int:
    """Run the command, see `derivation.cli.main`; return its exit status."""
    gc.set_threshold(ALLOCATIONS)
    try:
        from derivation import cli
    except KeyboardInterrupt:
        sys.stderr.write("platecontact: interrupted before it began; run the command again\n")
        return 2
    return cli.main()
