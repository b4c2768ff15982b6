"""Reproduces the tables and figures of the paper, one after the other.

    target/venv/bin/python examples/paper/all.py
"""
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent


def main():
    for script in sorted(HERE.glob("*_[0-9]*.py"), key=lambda path: (path.stem.split("_")[0], int(path.stem.split("_")[1]))):
        print(f"\n== {script.stem}", flush=True)
        subprocess.run([sys.executable, str(script)], check=True)


if __name__ == "__main__":
    main()
