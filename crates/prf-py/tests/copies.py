"""Every way to copy an object."""

import copy
import pickle
from collections.abc import Callable
from typing import Any


def _pickled(protocol: int) -> Callable[[Any], Any]:
    return lambda original: pickle.loads(pickle.dumps(original, protocol))


def _method(original: Any) -> Any:
    return original.copy()


COPIES: dict[str, Callable[[Any], Any]] = {
    "copy.copy": copy.copy,
    "copy.deepcopy": copy.deepcopy,
    "copy()": _method,
    **{f"pickle {protocol}": _pickled(protocol) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)},
}
