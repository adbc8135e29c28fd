import math

import numpy as np
import pytest
import reference
from pictures import Bytes, boxes, natural

import prf

TINY = natural(6, 8, seed=3), natural(6, 8, seed=4)


@pytest.mark.parametrize("goal", [natural(40, 60), boxes(84, 84), np.zeros((84, 84), np.uint8)])
def test_the_goal_itself_gets_exactly_1(goal: Bytes) -> None:
    assert prf.reward(goal, goal) == 1.0
    assert prf.reward(goal, goal, cell_px=3, block_cells=2, norm="l2-hys", scale="none") == 1.0
    assert prf.distance(goal, goal) == 0.0


@pytest.mark.parametrize("signed", [False, True])
def test_distance_and_reward_are_as_defined(signed: bool) -> None:
    goal, frame = TINY  # nothing in them is black, so they are compared whole
    features = [reference.hog(picture, 2, signed=signed) for picture in TINY]
    # 3 x 4 blocks of 9 features
    for divisor, distance, reward in [
        (
            1,
            prf.distance(goal, frame, cell_px=2, signed=signed, scale="none"),
            prf.reward(goal, frame, cell_px=2, signed=signed, scale="none"),
        ),
        (
            math.sqrt(12),
            prf.distance(goal, frame, cell_px=2, signed=signed),
            prf.reward(goal, frame, cell_px=2, signed=signed),
        ),
        (
            math.sqrt(12 * 9),
            prf.distance(goal, frame, cell_px=2, signed=signed, scale="sqrt-features"),
            prf.reward(goal, frame, cell_px=2, signed=signed, scale="sqrt-features"),
        ),
    ]:
        expected = reference.distance(features[0], features[1], divisor)
        assert distance == pytest.approx(expected, rel=1e-5)
        assert reward == pytest.approx(math.exp(-expected), rel=1e-5)
        assert 0 < reward < 1


def test_pictures_are_cropped_before_they_are_compared() -> None:
    goal, frame = np.zeros((50, 60), np.uint8), np.zeros((44, 37), np.uint8)
    goal[5:25, 7:27] = frame[20:40, 11:31] = natural(20, 20)
    assert prf.reward(goal, frame) == 1.0


def test_defaults_are_those_documented() -> None:
    goal, frame = natural(100, 100, seed=5), natural(100, 100, seed=6)
    assert prf.reward(goal, frame) == prf.reward(
        goal, frame, orientations=9, signed=False, cell=0.03, block_cells=1, norm="l2", scale="sqrt-blocks"
    )
    assert prf.distance(goal, frame) == prf.distance(goal, frame, cell_px=3)


def test_a_reward_that_underflows_is_not_0() -> None:
    goal, frame = natural(128, 128, seed=5), natural(128, 128, seed=6)
    assert prf.distance(goal, frame, cell_px=1, scale="none") > 90
    assert prf.reward(goal, frame, cell_px=1, scale="none") > 0


def test_a_frame_of_any_size_has_a_reward() -> None:
    goal = boxes(64, 64)
    for height, width in [(1, 1), (1, 300), (300, 1), (7, 9), (200, 100)]:
        frame = np.full((height, width), 9, np.uint8)
        assert 0 < prf.reward(goal, frame, cell_px=8, block_cells=2) <= 1
