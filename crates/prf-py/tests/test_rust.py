"""The package gives what the Rust crate gives, to the bit: crates/prf-core/tests/rust_golden.rs made the values."""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pictures import Bytes, read, read_frames

import prf

GOLDEN = Path(__file__).parents[3] / "tests" / "golden"
Floats = NDArray[np.float32]


def cases() -> list[Any]:
    index: list[dict[str, Any]] = json.loads((GOLDEN / "rust" / "index.json").read_text())
    values = np.fromfile(GOLDEN / "rust" / "values.f32", "<f4")
    ends = np.cumsum([case["len"] for case in index])
    assert ends[-1] == len(values)
    parts = np.split(values, ends[:-1])
    return [
        pytest.param(kind, case[kind], part, id=f"{number}-{kind}")
        for number, (case, part) in enumerate(zip(index, parts, strict=True))
        for kind in case.keys() - {"len"}
    ]


def options(params: dict[str, Any]) -> dict[str, Any]:
    """The keyword arguments that are these parameters of a configuration."""
    given = {**params, **params.get("hog", {})}
    given.pop("hog", None)
    for key, names in [
        ("cell", {"px": "cell_px", "fraction": "cell"}),
        ("delta", {"divisor": "delta_divisor", "duration": "duration"}),
    ]:
        for unit, value in given.pop(key, {}).items():
            given[names[unit]] = value
    return given


def goal_of(case: dict[str, Any]) -> prf.Goal:
    path, params = GOLDEN / case["goal"], options(case["params"])
    if case["descriptor"] == "direct":
        return prf.DirectGoal(path, **params)
    if case["descriptor"] == "motion":
        return prf.MotionGoal(path, **options(case["motion"]), **params)
    mask = GOLDEN / case["mask"] if "mask" in case else None
    return prf.WindowGoal(path, mask=mask, method=case["method"], **params)


def frames_of(case: dict[str, Any]) -> Bytes:
    return read_frames(GOLDEN / case["frames"])[: case["count"]]


def scores(goal: prf.Goal, frames: Bytes) -> Iterator[float]:
    for frame in frames:
        score = goal.score(frame)
        yield from score[:2]
        yield from score.match or ()


@pytest.mark.parametrize(("kind", "case", "expected"), cases())
def test_every_value_has_the_bits_of_rust(kind: str, case: dict[str, Any], expected: Floats) -> None:
    got: Floats
    if kind == "hog":
        got = prf.hog(read(GOLDEN / case["image"]), **options(case["params"]))
    elif kind == "match":
        mask = read(GOLDEN / case["mask"]) if "mask" in case else None
        image, template = read(GOLDEN / case["image"]), read(GOLDEN / case["template"])
        got = prf.match_template(image, template, mask=mask, method=case["method"])
    elif kind == "score":
        got = np.array(list(scores(goal_of(case), frames_of(case))), np.float32)
    elif kind == "motion":
        motion = prf.MotionTemplate(**options(case["params"]))
        for frame in frames_of(case):
            motion.update(frame)
        got = motion.history
    else:
        state = prf.EmaState(decay=case["lambda"])
        for frame in frames_of(case):
            state.update(frame)
        got = state.values
    np.testing.assert_array_equal(got.ravel().view(np.uint32), expected.view(np.uint32))


def test_motion_histories_are_opencv_s_to_the_bit() -> None:
    index: list[dict[str, Any]] = json.loads((GOLDEN / "motion" / "index.json").read_text())
    pixels = np.fromfile(GOLDEN / "motion" / "pictures.u8", np.uint8)
    history = np.fromfile(GOLDEN / "motion" / "history.f32", "<f4")
    seen = 0
    for case in index:
        shape, count = (case["height"], case["width"]), case["pictures"]
        size = shape[0] * shape[1]
        pictures, pixels = pixels[: count * size].reshape(-1, *shape), pixels[count * size :]
        params: dict[str, Any] | None = case["input"].get("observe")
        iterations = count if params is None else count - 1
        histories, history = history[: iterations * size].reshape(-1, *shape), history[iterations * size :]
        if params is None:
            continue
        motion = prf.MotionTemplate(**options(params))
        motion.update(pictures[0])
        for picture, expected in zip(pictures[1:], histories, strict=True):
            motion.update(picture)
            np.testing.assert_array_equal(motion.history.view(np.uint32), expected.view(np.uint32))
            seen += 1
    assert seen > 40
