"""The entry point of the command, so that Ctrl-C while its modules load gives one message, too."""

import sys


def main() -> int:
    """Run the command, see `derivation.cli.main`; return its exit status."""
    try:
        from derivation import cli
    except KeyboardInterrupt:
        sys.stderr.write("platecontact: interrupted before it began; run the command again\n")
        return 2
    return cli.main()
