"""Goals of every kind: scores, episodes, copies, pictures that explain."""

import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from copies import COPIES
from pictures import boxes, moving, natural

import prf

FRAMES = moving(12, 84, 84)
PART = FRAMES[6, 4:30, 26:44]
GOALS: dict[str, Callable[[], prf.Goal]] = {
    "direct": lambda: prf.DirectGoal(FRAMES[-1]),
    "direct, other options": lambda: prf.DirectGoal(
        boxes(70, 60), orientations=7, signed=True, cell_px=6, block_cells=2, norm="l2-hys", scale="none"
    ),
    "window": lambda: prf.WindowGoal(PART),
    "window, masked": lambda: prf.WindowGoal(
        PART, mask=PART > 9, method="ccoeff-normed", cell=0.25, norm="l1-sqrt"
    ),
    "motion": lambda: prf.MotionGoal(FRAMES),
    "motion, other options": lambda: prf.MotionGoal(
        FRAMES, threshold=9, tau_start=0.3, tau_step=0.3, duration=1.25, skip_still=True, cell=0.1
    ),
}
goals = pytest.mark.parametrize("name", GOALS)


@goals
def test_a_score_has_names(name: str) -> None:
    goal, twin = GOALS[name](), GOALS[name]()
    for frame in FRAMES:
        score = goal.score(frame)
        assert score == (score.reward, score.distance, score.match)
        assert type(score.reward) is type(score.distance) is float
        assert 0 < score.reward <= 1
        assert score.reward == pytest.approx(math.exp(-score.distance), rel=1e-6)
        assert twin.reward(frame) == score.reward
        assert isinstance(score.match, prf.Match) == (type(goal) is prf.WindowGoal)
        assert pickle.loads(pickle.dumps(score)) == score


def test_a_direct_goal_gives_what_the_functions_give() -> None:
    for options in ({}, {"cell_px": 5, "block_cells": 2, "norm": "l2-hys", "scale": "none", "signed": True}):
        given: dict[str, Any] = options
        goal = prf.DirectGoal(boxes(70, 60), **given)
        for frame in (*FRAMES[:4], natural(30, 50), np.zeros((9, 9), np.uint8)):
            score = goal.score(frame)
            assert score.reward == prf.reward(boxes(70, 60), frame, **given)
            assert score.distance == prf.distance(boxes(70, 60), frame, **given)


@pytest.mark.parametrize("method", ["ccorr-normed", "ccoeff-normed"])
def test_a_window_is_where_the_template_matches_best(method: Any) -> None:
    goal = prf.WindowGoal(PART, method=method)
    for frame in (*FRAMES, natural(60, 70)):
        matched = goal.score(frame).match
        assert matched is not None
        scores = prf.match_template(frame, PART, method=method)
        assert matched[2:4] == (PART.shape[1], PART.shape[0])
        assert matched.score == pytest.approx(scores.max(), abs=1e-4)
        assert scores[matched.y, matched.x] == pytest.approx(scores.max(), abs=1e-4)
        window = frame[matched.y : matched.y + matched.height, matched.x : matched.x + matched.width]
        assert goal.reward(frame) == prf.reward(PART, window, cell=0.1)


def test_a_window_is_found_at_x_and_y() -> None:
    goal = prf.WindowGoal(natural(14, 23, seed=9))
    frame = natural(60, 80)
    frame[31:45, 50:73] = natural(14, 23, seed=9)
    assert goal.score(frame) == prf.Score(1.0, 0.0, prf.Match(x=50, y=31, width=23, height=14, score=1.0))


def test_what_the_mask_leaves_out_does_not_count() -> None:
    picture, frame = natural(20, 24), natural(60, 70, seed=2)
    mask = np.zeros((20, 24), bool)
    mask[3:17, 5:20] = True
    frame[30:50, 41:65] = np.where(mask, picture, 255 - picture)
    masked, whole = prf.WindowGoal(picture, mask=mask), prf.WindowGoal(picture)
    assert masked.score(frame)[:2] == (1, 0)
    assert whole.reward(frame) < 0.9
    assert prf.WindowGoal(picture, mask=mask.astype(np.uint8) * 9).score(frame) == masked.score(frame)
    assert whole.mask is None
    np.testing.assert_array_equal(masked.mask, mask)


def test_a_motion_goal_compares_templates() -> None:
    options: dict[str, Any] = {"threshold": 20, "duration": 1.0}
    goal = prf.MotionGoal(FRAMES, **options)
    template = prf.motion_template(FRAMES, **options)
    np.testing.assert_array_equal(goal.goal, template)
    np.testing.assert_array_equal(prf.MotionGoal(template, **options).goal, template)
    frames = moving(9, 84, 84)[::-1]
    goal.reset(frames[0])
    for count in range(2, 10):
        expected = prf.reward(template, prf.motion_template(frames[:count], **options), cell=0.05)
        assert goal.reward(frames[count - 1]) == expected


@goals
def test_an_episode_begins_with_a_reset(name: str) -> None:
    goal = GOALS[name]()
    first = [goal.reward(frame) for frame in FRAMES]
    goal.reset()
    assert [goal.reward(frame) for frame in FRAMES] == first
    goal.reset(FRAMES[0])
    assert [goal.reward(frame) for frame in FRAMES[1:]] == first[1:]
    goal.reset()
    assert goal.rewards(FRAMES).tolist() == first
    goal.reset()
    assert goal.rewards(FRAMES[:5]).tolist() + goal.rewards(FRAMES[5:]).tolist() == first


def test_the_order_of_frames_counts_for_motion_alone() -> None:
    for name, make in GOALS.items():
        forward, backward = make().rewards(FRAMES), make().rewards(FRAMES[::-1])
        assert (forward == backward[::-1]).all() == (not name.startswith("motion"))


@goals
@pytest.mark.parametrize("duplicate", COPIES)
def test_a_copy_goes_on_by_itself(name: str, duplicate: str) -> None:
    goal = GOALS[name]()
    expected = GOALS[name]().rewards(FRAMES).tolist()
    for count, frame in enumerate(FRAMES):
        other: prf.Goal = COPIES[duplicate](goal)
        assert type(other) is type(goal)
        assert repr(other) == repr(goal)
        np.testing.assert_array_equal(other.goal, goal.goal)
        assert other.rewards(FRAMES[count:]).tolist() == expected[count:]
        assert goal.reward(frame) == expected[count]


@goals
def test_to_explain_changes_nothing(name: str) -> None:
    goal, twin = GOALS[name](), GOALS[name]()
    for frame in FRAMES:
        picture = goal.explain(frame)
        assert picture.shape == (882, 1160, 3)
        assert picture.dtype == np.uint8
        np.testing.assert_array_equal(goal.explain(frame), picture)
        goal.explain(natural(84, 84))
        assert goal.score(frame) == twin.score(frame)


def test_an_explanation_shows_goal_and_agent() -> None:
    goal, frame = boxes(64, 64), natural(64, 64)
    picture = prf.DirectGoal(goal).explain(frame)
    other = prf.DirectGoal(goal).explain(255 - frame)
    # Panels of 360 px: the goal's on the left is the same, the agent's beside it isn't.
    np.testing.assert_array_equal(picture[54:414, 20:380], other[54:414, 20:380])
    assert (picture[54:414, 400:760] != other[54:414, 400:760]).any()
    enlarged = np.arange(360) * 64 // 360
    for left, shown in [(20, goal), (400, frame)]:
        panel = picture[54:414, left : left + 360]
        same = (panel == shown[np.ix_(enlarged, enlarged)][..., None]).all(axis=2)
        assert same.mean() > 0.97  # but for the outline of what is compared


def test_an_explanation_of_motion_is_that_of_the_next_frame() -> None:
    goal, fresh = prf.MotionGoal(FRAMES), prf.MotionGoal(FRAMES)
    for frame in FRAMES[:5]:
        goal.reward(frame)
    assert (goal.explain(FRAMES[5]) != fresh.explain(FRAMES[5])).any()
    template = prf.motion_template(FRAMES[:6])
    expected = prf.DirectGoal(goal.goal, cell=0.05).explain(template)
    np.testing.assert_array_equal(goal.explain(FRAMES[5]), expected)


@goals
def test_the_goal_is_a_copy(name: str) -> None:
    goal = GOALS[name]()
    picture = goal.goal
    kept = picture.copy()
    picture[:] = 3
    np.testing.assert_array_equal(goal.goal, kept)


def test_a_goal_keeps_what_it_was_given() -> None:
    picture = boxes(40, 40)
    goal = prf.DirectGoal(picture)
    expected = goal.reward(FRAMES[0])
    picture[:] = 9
    assert goal.reward(FRAMES[0]) == expected
    np.testing.assert_array_equal(goal.goal, boxes(40, 40))


def test_options_are_properties() -> None:
    goal = prf.WindowGoal(
        PART, orientations=7, signed=True, cell_px=3, block_cells=2, norm="l1", scale="none"
    )
    assert (goal.orientations, goal.signed, goal.cell, goal.cell_px, goal.block_cells) == (
        7,
        True,
        None,
        3,
        2,
    )
    assert (goal.norm, goal.scale, goal.method) == ("l1", "none", "ccorr-normed")
    assert repr(goal) == (
        "WindowGoal(<18x26 px>, method='ccorr-normed', orientations=7, signed=True, cell_px=3, block_cells=2, "
        "norm='l1', scale='none')"
    )
    masked = prf.WindowGoal(PART, mask=PART > 9, method="ccoeff-normed")
    assert (masked.cell, masked.cell_px, masked.method) == (0.1, None, "ccoeff-normed")
    assert repr(masked).startswith("WindowGoal(<18x26 px>, mask=<18x26 px>, method='ccoeff-normed', ")
    direct = prf.DirectGoal(PART)
    assert (direct.cell, direct.norm, direct.scale) == (0.03, "l2", "sqrt-blocks")
    motion = prf.MotionGoal(FRAMES)
    assert (motion.cell, motion.threshold, motion.tau_start, motion.tau_step) == (0.05, 30, 0.1, 0.4)
    assert (motion.delta_divisor, motion.duration, motion.skip_still) == (3, None, False)
    motion = prf.MotionGoal(FRAMES, duration=0.7, skip_still=True)
    assert (motion.delta_divisor, motion.duration, motion.skip_still) == (None, 0.7, True)
