"""The command line, as ``opshock`` and as ``python -m opshock``."""

import signal
import sys

from . import _native


def main() -> None:
    """Runs the command line with the arguments of the process, and ends with its exit code."""
    # Python's own handler would only note Ctrl-C while the command runs.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sys.exit(_native.main(["opshock", *sys.argv[1:]]))


if __name__ == "__main__":
    main()
