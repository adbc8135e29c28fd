"""Frames, goals and options that a goal can do nothing with."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from pictures import moving
from refusal import refuse
from untyped import numpy_ma

import prf

FRAMES = moving(12, 84, 84)
PART = FRAMES[6, 4:30, 26:44]
GOALS: dict[str, Callable[[], prf.Goal]] = {
    "direct": lambda: prf.DirectGoal(FRAMES[-1]),
    "window": lambda: prf.WindowGoal(PART),
    "motion": lambda: prf.MotionGoal(FRAMES),
}
goals = pytest.mark.parametrize("name", GOALS)


@goals
@pytest.mark.parametrize(
    ("frame", "error", "message"),
    [
        (None, TypeError, "frame: got NoneType, expected a NumPy array of shape (height, width)"),
        ([[1, 2]], TypeError, "frame: got list, expected a NumPy array of shape (height, width)"),
        ("frame.png", TypeError, "frame: got str, expected a NumPy array of shape (height, width)"),
        (FRAMES[0] / 255, TypeError, "frame: got an array of float64, expected uint8; for floats"),
        (numpy_ma.masked_less(FRAMES[0], 9), TypeError, "frame: got a masked array, expected a plain one"),
        (FRAMES, ValueError, "frame: got shape (12, 84, 84), expected (height, width)"),
        (
            FRAMES[0][:0],
            ValueError,
            "frame: got shape (0, 84), expected (height, width) with sides of 1 to 16384",
        ),
        (np.zeros((84, 84, 3), np.uint8), ValueError, "turn colours to grey first"),
    ],
)
def test_what_is_no_frame_is_refused(name: str, frame: Any, error: type[Exception], message: str) -> None:
    goal, twin = GOALS[name](), GOALS[name]()
    goal.reward(FRAMES[0])
    twin.reward(FRAMES[0])
    for method in (goal.reward, goal.score, goal.explain):
        refuse(lambda: method(frame), error, message)
    if frame is not None:
        refuse(lambda: goal.reset(frame), error, message)
    assert goal.reward(FRAMES[1]) == twin.reward(FRAMES[1])


def test_a_window_larger_than_the_frame_is_refused() -> None:
    goal = prf.WindowGoal(PART)
    message = "a template of 18x26 px doesn't fit into a frame of 84x25 px"
    for call in (goal.reset, goal.reward, goal.score, goal.explain):
        refuse(lambda: call(FRAMES[0][:25]), ValueError, f"frame: {message}")
    refuse(lambda: goal.rewards(FRAMES[:, :25]), ValueError, f"frames: {message}")


def test_an_episode_of_motion_has_one_size() -> None:
    goal, twin = prf.MotionGoal(FRAMES), prf.MotionGoal(FRAMES)
    for frame in FRAMES[:3]:
        goal.reward(frame)
        twin.reward(frame)
    message = "got a frame of 84x60 px, expected 84x84 as the frames before it"
    for call in (goal.reward, goal.score, goal.explain):
        refuse(lambda: call(FRAMES[3][:60]), ValueError, f"frame: {message}")
    refuse(lambda: goal.rewards(FRAMES[:, :60]), ValueError, f"frames: {message}")
    assert goal.reward(FRAMES[3]) == twin.reward(FRAMES[3])
    goal.reset(FRAMES[0][:60])
    assert 0 < goal.reward(FRAMES[1][:60]) <= 1


def test_a_goal_by_itself_can_not_be_made() -> None:
    make: Any = prf.Goal
    refuse(lambda: make(), TypeError, "Goal")
    for kind in (prf.DirectGoal, prf.WindowGoal, prf.MotionGoal):
        assert issubclass(kind, prf.Goal)


@pytest.mark.parametrize("kind", [prf.DirectGoal, prf.WindowGoal, prf.MotionGoal])
@pytest.mark.parametrize(
    ("goal", "error", "message"),
    [
        (None, TypeError, "goal: got NoneType, expected a NumPy array of shape (height, width)"),
        ([[1]], TypeError, "or the path of a file as str or os.PathLike"),
        (b"goal.png", TypeError, "goal: got bytes, expected a NumPy array"),
        (np.zeros((9, 9)), TypeError, "goal: got an array of float64, expected uint8"),
        (np.zeros(9, np.uint8), ValueError, "goal: got shape (9), expected (height, width)"),
        (np.zeros((9, 0), np.uint8), ValueError, "goal: got shape (9, 0), expected (height, width)"),
        (
            np.zeros((9, 9, 9, 3), np.uint8),
            ValueError,
            "goal: got shape (9, 9, 9, 3), expected (height, width)",
        ),
        (numpy_ma.masked_less(np.ones((9, 9), np.uint8), 2), TypeError, "goal: got a masked array"),
    ],
)
def test_what_is_no_goal_is_refused(kind: Any, goal: Any, error: type[Exception], message: str) -> None:
    refuse(lambda: kind(goal), error, message)


def test_options_that_do_not_fit_the_goal_are_refused() -> None:
    for kind in (prf.DirectGoal, prf.WindowGoal, prf.MotionGoal):
        message = "goal: a picture of 18x26 px is too small for 1x1 cells of 40 px"
        refuse(lambda: kind(PART, cell_px=40), ValueError, message)
    window: Any = prf.WindowGoal
    refuse(lambda: window(PART, mask=PART[1:]), ValueError, "mask: got 18x25 px, expected 18x26 px")
    refuse(
        lambda: window(PART, mask=PART * 0), ValueError, "mask: got only zeros, expected a pixel that counts"
    )
    refuse(lambda: window(PART, mask=PART / 255), TypeError, "mask: got an array of float64, expected uint8 or bool")
    refuse(
        lambda: window(PART, mask=3),
        TypeError,
        "mask: got int, expected a NumPy array",
        "or the path of a file",
    )
    refuse(
        lambda: window(PART, method="best"),
        ValueError,
        "method: got 'best', expected one of 'ccorr-normed', 'ccoeff-normed'",
    )


def test_a_state_of_another_goal_is_refused() -> None:
    refuse(
        lambda: prf.DirectGoal(PART).__setstate__(b"state"),
        ValueError,
        "state: the saved state holds 5 bytes",
    )
    refuse(lambda: prf.MotionGoal(FRAMES).__setstate__(b"state"), ValueError, "state: the saved state holds")


def test_more_features_than_memory_are_refused_at_once() -> None:
    large = np.full((8192, 8191), 9, np.uint8)
    large[0, 0] = 0
    options: dict[str, Any] = {"cell_px": 1, "orientations": 64}
    message = "features, expected at most 268435456: take larger cells"
    for kind in (prf.DirectGoal, prf.WindowGoal, prf.MotionGoal):
        refuse(lambda: kind(large, **options), ValueError, message)
    refuse(lambda: prf.DirectGoal(PART, **options).reward(large), ValueError, message)
    refuse(lambda: prf.MotionGoal(FRAMES, **options).reward(large), ValueError, message)


def test_large_frames_have_a_reward_where_cells_are_large() -> None:
    large = np.full((4096, 4096), 9, np.uint8)
    large[1000:3000, 500:700] = 200
    for goal in (prf.DirectGoal(PART, block_cells=3), prf.MotionGoal(FRAMES, block_cells=3)):
        assert 0 < goal.reward(large) <= 1
