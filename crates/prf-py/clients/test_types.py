import subprocess
import sys
from pathlib import Path

FOLDER = Path(__file__).parent


def test_types_are_strict() -> None:
    mypy = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", FOLDER.name], cwd=FOLDER.parent, capture_output=True, text=True
    )
    assert mypy.returncode == 0, mypy.stdout + mypy.stderr
