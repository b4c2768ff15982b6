"""The command line: ``python -m motet``, also installed as the script ``motet``."""
from __future__ import annotations

import signal
import sys

from ._motet import command


def main() -> int:
    """Run the command line with ``sys.argv`` and return its exit status."""
    # Python handles no signals during the native call, so Ctrl-C must end the process directly.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return command(["motet", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
