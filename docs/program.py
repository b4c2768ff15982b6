"""Finds the program called by scripts of docs/ and examples/."""
import os
import sys
from pathlib import Path

SUFFIX = ".exe" if os.name == "nt" else ""


def binary():
    """Return the path of the program, in $MOTET_BIN_DIR or in the output folder of `cargo build
    --release`."""
    path = Path(os.environ.get("MOTET_BIN_DIR") or Path(__file__).resolve().parent.parent / "target" / "release").resolve() / f"motet{SUFFIX}"
    if not path.exists():
        sys.exit(f"{path} does not exist: run cargo build --release, or set MOTET_BIN_DIR to its folder")
    return path
