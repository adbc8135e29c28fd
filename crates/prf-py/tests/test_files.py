"""Goals from files, and what is wrong with files."""

import errno
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from pictures import Bytes, boxes, moving
from refusal import refuse

import prf

FRAMES = moving(8, 40, 50)
KINDS: list[Any] = [prf.DirectGoal, prf.WindowGoal, prf.MotionGoal]
kinds = pytest.mark.parametrize("kind", KINDS)


def save(path: Path, frames: Bytes) -> Path:
    pictures = [Image.fromarray(frame) for frame in frames]
    pictures[0].save(path, save_all=len(pictures) > 1, append_images=pictures[1:])
    return path


@kinds
@pytest.mark.parametrize("suffix", ["png", "bmp"])
def test_a_path_is_the_picture_that_lies_there(kind: Any, suffix: str, tmp_path: Path) -> None:
    path = save(tmp_path / f"goal.{suffix}", boxes(40, 50)[None])
    expected = kind(boxes(40, 50))
    for given in (path, str(path)):
        goal = kind(given)
        np.testing.assert_array_equal(goal.goal, boxes(40, 50))
        assert goal.reward(FRAMES[0]) == expected.reward(FRAMES[0])
        goal.reset()
        expected.reset()


def test_colours_become_grey(tmp_path: Path) -> None:
    Image.new("RGB", (30, 20), (255, 0, 0)).save(tmp_path / "red.png")
    goal = prf.DirectGoal(tmp_path / "red.png").goal
    assert (goal == goal[0, 0]).all()
    assert 0 < goal[0, 0] < 255


def test_a_mask_may_lie_in_a_file(tmp_path: Path) -> None:
    mask = np.where(boxes(40, 50) > 100, np.uint8(255), np.uint8(0))
    path = save(tmp_path / "mask.png", mask[None])
    expected = prf.WindowGoal(boxes(40, 50), mask=mask)
    for given in (path, str(path)):
        goal = prf.WindowGoal(boxes(40, 50), mask=given)
        np.testing.assert_array_equal(goal.mask, mask)
        assert goal.score(FRAMES[0]) == expected.score(FRAMES[0])


@pytest.mark.parametrize("form", ["goal.png", "folder"])
def test_a_sequence_of_motion_may_be_an_animation_or_a_folder(form: str, tmp_path: Path) -> None:
    path = tmp_path / form
    if form == "folder":
        path.mkdir()
        for t, frame in enumerate(FRAMES):
            save(path / f"frame{t + 6}.png", frame[None])  # frame10 comes after frame9
    else:
        save(path, FRAMES)
    np.testing.assert_array_equal(
        prf.MotionGoal(path, threshold=20).goal, prf.motion_template(FRAMES, threshold=20)
    )


@kinds
def test_a_file_that_is_missing_is_named(kind: Any, tmp_path: Path) -> None:
    path = tmp_path / "no goal.png"
    for given in (path, str(path)):
        with pytest.raises(FileNotFoundError, match="no goal.png") as caught:
            kind(given)
        assert (caught.value.errno, caught.value.filename) == (errno.ENOENT, str(path))
    with pytest.raises(FileNotFoundError) as caught:
        prf.WindowGoal(boxes(9, 9), mask=path)
    assert caught.value.filename == str(path)


def test_a_folder_is_no_picture(tmp_path: Path) -> None:
    for kind in KINDS[:2]:
        with pytest.raises(IsADirectoryError) as caught:
            kind(tmp_path)
        assert caught.value.filename == str(tmp_path)
    refuse(lambda: prf.MotionGoal(tmp_path), ValueError, str(tmp_path), "the folder holds no picture")


@kinds
@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "the file is empty (0 bytes), expected a picture"),
        (b"just words", 'not a picture that can be read (it begins with "just wor")'),
        (b"\x89PNG\r\n\x1a\n", "PNG is "),
    ],
)
def test_a_file_that_is_no_picture_is_named(kind: Any, content: bytes, message: str, tmp_path: Path) -> None:
    path = tmp_path / "goal.png"
    path.write_bytes(content)
    refuse(lambda: kind(path), ValueError, f"{path}: ", message)


@kinds
def test_a_path_that_can_not_be_one_is_refused(kind: Any) -> None:
    refuse(lambda: kind("a\0b"), ValueError, r"goal: got 'a\x00b', expected a path without null characters")
    with pytest.raises(OSError) as caught:
        kind("x" * 5000)
    assert (caught.value.errno, caught.value.filename) == (errno.ENAMETOOLONG, "x" * 5000)

    class Path:
        def __fspath__(self) -> bytes:
            return b"goal.png"

    with pytest.raises(TypeError):
        kind(Path())


def test_a_sequence_that_is_no_goal_says_why(tmp_path: Path) -> None:
    still = np.repeat(FRAMES[:1], 3, axis=0)
    forgotten = np.concatenate([FRAMES[:3], np.repeat(FRAMES[3:4], 9, axis=0)])
    cases: list[tuple[Bytes, dict[str, Any], str]] = [
        (FRAMES[:0], {}, "got no frame, expected at least 2"),
        (FRAMES[:1], {}, "got 1 frame, expected at least 2"),
        (
            still,
            {},
            "nothing moves: the largest change of a pixel from one frame to the next is 0, the threshold 30",
        ),
        (FRAMES // 4, {"threshold": 99}, "nothing moves"),
        (
            forgotten,
            {"duration": 0.5},
            "forgotten by the sequence's end, so the template is black: `duration` is 0.5",
        ),
        (forgotten, {"delta_divisor": 90}, "`delta_divisor` is 90, expected at most"),
    ]
    for frames, options, message in cases:
        sources: list[tuple[Any, str]] = [(frames, "goal")]
        if len(frames) > 1:
            path = save(tmp_path / "goal.png", frames)
            sources.append((path, str(path)))
        for source, name in sources:
            refuse(lambda: prf.MotionGoal(source, **options), ValueError, f"{name}: ", message)


def test_a_goal_without_direction_warns(tmp_path: Path) -> None:
    message = "goal: of 7 movements the template holds only the newest.*take a larger `duration`"
    for goal in (FRAMES, save(tmp_path / "goal.png", FRAMES)):
        with pytest.warns(UserWarning, match=message) as caught:
            prf.MotionGoal(goal, duration=0)
        assert [warning.filename for warning in caught] == [__file__]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UserWarning, match=message):
            prf.MotionGoal(FRAMES, duration=0)
