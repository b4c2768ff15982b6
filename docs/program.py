"""Where the program is that scripts of docs/ and examples/ call."""
import os
import sys
from pathlib import Path

SUFFIX = ".exe" if os.name == "nt" else ""


def binary():
    """The program: in $MOTET_BIN_DIR, or where `cargo build --release` puts it."""
    path = Path(os.environ.get("MOTET_BIN_DIR") or Path(__file__).resolve().parent.parent / "target" / "release").resolve() / f"motet{SUFFIX}"
    if not path.exists():
        sys.exit(f"{path} is not there: cargo build --release, or say in MOTET_BIN_DIR in which folder it is")
    return path
