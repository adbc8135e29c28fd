"""What only a part of the package needs."""

from importlib.util import find_spec


def has_gymnasium() -> bool:
    """Whether Gymnasium is installed."""
    return find_spec("gymnasium") is not None


def require_gymnasium(module: str) -> None:
    """Says how to get Gymnasium where ``module`` needs it and it is not installed."""
    if not has_gymnasium():
        message = f"{module} needs Gymnasium, which is not installed: run `pip install \"prf-py[gymnasium]\"`"
        raise ModuleNotFoundError(message, name="gymnasium")
