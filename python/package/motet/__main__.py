"""The command line: ``python -m motet``, and the ``motet`` that is installed with the package."""
from __future__ import annotations

import signal
import sys

from ._motet import command


def main() -> int:
    """Runs the words of the call; the exit status."""
    # The interpreter is not asked while motet works: Ctrl-C has to end the process by itself.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["motet", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
