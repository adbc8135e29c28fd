"""The command line of the package, run as a user runs it."""

import subprocess
import sys
from pathlib import Path

PRF = [sys.executable, "-m", "prf"]


def prf(folder: Path, *arguments: str) -> "subprocess.CompletedProcess[str]":
    """What ``python -m prf`` says and ends with in ``folder``."""
    return subprocess.run([*PRF, *arguments], cwd=folder, capture_output=True, encoding="utf-8")
