"""What only a part of the package needs."""

import re
from importlib.metadata import PackageNotFoundError, version
from importlib.util import find_spec

OLDEST_GYMNASIUM = (1, 1)
"""As pyproject.toml asks for, which doesn't keep pip from leaving an older one where it is."""


def has_gymnasium() -> bool:
    """Whether a Gymnasium is installed that is new enough."""
    installed = gymnasium_version()
    return installed is not None and is_new_enough(installed)


def require_gymnasium(module: str) -> None:
    """Says how to get Gymnasium where ``module`` needs it and it is not installed, or too old."""
    installed = gymnasium_version()
    how = 'run `pip install "prf-py[gymnasium]"`'
    if installed is None:
        raise ModuleNotFoundError(f"{module} needs Gymnasium, which is not installed: {how}", name="gymnasium")
    if not is_new_enough(installed):
        oldest = ".".join(map(str, OLDEST_GYMNASIUM))
        raise ImportError(f"{module}: got Gymnasium {installed}, expected {oldest} or newer: {how}", name="gymnasium")


def gymnasium_version() -> str | None:
    """Which Gymnasium is installed, if one is. It is not imported for that: an old one may fail."""
    try:
        return version("gymnasium") if find_spec("gymnasium") else None
    except PackageNotFoundError:
        return None


def is_new_enough(installed: str) -> bool:
    """Whether a version is at least the oldest."""
    numbers = re.match(r"(\d+)\.(\d+)", installed)
    return numbers is not None and (int(numbers[1]), int(numbers[2])) >= OLDEST_GYMNASIUM
