"""Options out of range are refused with what was got and what was expected, by every function."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from pictures import natural

import prf

IMAGE = natural(24, 36)
FUNCTIONS: list[Callable[..., object]] = [
    partial(prf.hog, IMAGE),
    partial(prf.reward, IMAGE, IMAGE),
    partial(prf.distance, IMAGE, IMAGE),
    partial(prf.hog_batch, IMAGE[None]),
    partial(prf.reward_batch, IMAGE, IMAGE[None]),
    partial(prf.distance_batch, IMAGE, IMAGE[None]),
    partial(prf.DirectGoal, IMAGE),
    partial(prf.WindowGoal, IMAGE),
    partial(prf.MotionGoal, IMAGE),
]
COMPARING = [function for function in FUNCTIONS if FUNCTIONS.index(function) not in (0, 3)]
TOO_MANY = 10**30


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"orientations": 0}, "orientations: got 0, expected 1 to 64"),
        ({"orientations": 65}, "orientations: got 65, expected 1 to 64"),
        ({"orientations": -1}, "orientations: got -1, expected an int of at least 1"),
        ({"orientations": TOO_MANY}, f"orientations: got {TOO_MANY}, expected an int"),
        ({"cell": 0.0}, "cell: got 0, expected above 0 and at most 1"),
        ({"cell": -0.5}, "cell: got -0.5, expected above 0 and at most 1"),
        ({"cell": 10**400}, "cell: got 1000"),
        ({"cell": float("nan")}, "cell: got NaN, expected above 0 and at most 1"),
        ({"cell": 1.5}, "cell: got 1.5, expected above 0 and at most 1"),
        ({"cell_px": 0}, "cell_px: got 0, expected at least 1"),
        ({"cell_px": -8}, "cell_px: got -8, expected an int of at least 1"),
        ({"cell": 0.5, "cell_px": 8}, "got both cell and cell_px, expected one of them"),
        ({"block_cells": 0}, "block_cells: got 0, expected at least 1"),
        ({"block_cells": -2}, "block_cells: got -2, expected an int of at least 1"),
        (
            {"norm": "L2"},
            "norm: got 'L2', expected one of 'none', 'l1', 'l1-sqrt', 'l2', 'l2-hys'",
        ),
        ({"cell_px": 25}, "a picture of 36x24 px is too small for 1x1 cells of 25 px"),
        ({"cell_px": 8, "block_cells": 4}, "a picture of 36x24 px is too small for 4x4 cells of 8 px"),
        ({"cell_px": 2**63, "block_cells": 2**63}, "a picture of 36x24 px is too small"),
    ],
)
@pytest.mark.parametrize("function", FUNCTIONS)
def test_a_value_out_of_range(function: Callable[..., object], options: dict[str, Any], message: str) -> None:
    with pytest.raises(ValueError) as caught:
        function(**options)
    assert type(caught.value) is ValueError
    assert message in str(caught.value)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"orientations": "9"}, "orientations: got str, expected an int of at least 1"),
        ({"orientations": 9.0}, "orientations: got float, expected an int of at least 1"),
        ({"orientations": None}, "orientations: got NoneType, expected an int of at least 1"),
        ({"signed": 1}, "signed: got int, expected a bool"),
        ({"cell": "0.03"}, "cell: got str, expected a float"),
        ({"cell_px": 2.5}, "cell_px: got float, expected an int of at least 1"),
        ({"block_cells": [1]}, "block_cells: got list, expected an int of at least 1"),
        ({"norm": None}, "norm: got NoneType, expected a str"),
        ({"norm": 2}, "norm: got int, expected a str"),
    ],
)
@pytest.mark.parametrize("function", FUNCTIONS)
def test_a_value_of_another_type(
    function: Callable[..., object], options: dict[str, Any], message: str
) -> None:
    with pytest.raises(TypeError, match=message):
        function(**options)


@pytest.mark.parametrize("function", FUNCTIONS)
def test_an_unknown_option_is_named(function: Callable[..., object]) -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'cells'"):
        function(cells=3)


def test_scales_are_named() -> None:
    scale: Any = "blocks"
    for function in COMPARING:
        with pytest.raises(
            ValueError, match="scale: got 'blocks', expected one of 'none', 'sqrt-blocks'"
        ):
            function(scale=scale)


def test_options_may_be_numpy_scalars() -> None:
    expected = prf.hog(IMAGE, orientations=7, signed=True, cell=0.25, block_cells=2)
    options: dict[str, Any] = {
        "orientations": np.int16(7),
        "signed": np.bool_(True),
        "cell": np.float32(0.25),
        "block_cells": np.uint8(2),
    }
    np.testing.assert_array_equal(prf.hog(IMAGE, **options), expected)


@pytest.mark.parametrize("function", [prf.reward, prf.distance])
def test_more_features_than_memory_are_refused_at_once(function: Callable[..., object]) -> None:
    picture = np.full((8192, 8191), 9, np.uint8)
    picture[0, 0] = 0
    for options in ({"cell_px": 1, "orientations": 64}, {"cell_px": 1, "block_cells": 5000}):
        with pytest.raises(ValueError, match="features, expected at most 268435456: take larger cells"):
            prf.hog(picture, **options)  # type: ignore[arg-type]
        for goal, frame in [(picture, IMAGE), (IMAGE, picture)]:
            with pytest.raises(ValueError):
                function(goal, frame, **options)


def test_large_blocks_are_refused_only_where_they_fit() -> None:
    goal, frame = np.full((150, 150), 9, np.uint8), np.full((16384, 1), 9, np.uint8)
    options: dict[str, Any] = {"cell_px": 1, "block_cells": 150, "orientations": 64}
    assert prf.reward(goal, frame, **options) == 1.0
    frame = np.full((300, 300), 9, np.uint8)
    with pytest.raises(ValueError, match="features, expected at most"):
        prf.reward(goal, frame, **options)
