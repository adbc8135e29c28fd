import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).parent


def test_types_are_strict() -> None:
    mypy = [sys.executable, "-m", "mypy", "--strict", FOLDER.name]
    ended = subprocess.run(mypy, cwd=FOLDER.parent, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr
