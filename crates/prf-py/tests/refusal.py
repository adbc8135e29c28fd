"""Calls that have to be refused."""

from collections.abc import Callable

import pytest


def refuse(call: Callable[[], object], error: type[Exception], *parts: str) -> None:
    """The call raises exactly this kind of error, whose message has these parts."""
    with pytest.raises(error) as caught:
        call()
    assert type(caught.value) is error
    for part in parts:
        assert part in str(caught.value)
