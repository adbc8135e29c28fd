"""Averages of frames, against OpenCV."""

from typing import Any

import cv2
import numpy as np
import pytest
from copies import COPIES
from pictures import moving
from refusal import refuse

import prf

FRAMES = moving(12, 20, 30)


@pytest.mark.parametrize("decay", [0, 0.3, 0.7, 0.95])
def test_the_average_is_opencv_s(decay: float) -> None:
    state = prf.EmaState(decay=decay)
    expected = FRAMES[0].astype(np.float32)
    for frame in FRAMES:
        cv2.accumulateWeighted(frame, expected, 1 - decay)
        got = state.update(frame)
        np.testing.assert_allclose(state.values, expected, rtol=0, atol=1e-3)
        np.testing.assert_array_equal(got, np.rint(state.values).astype(np.uint8))
        np.testing.assert_array_equal(got, state.state)
        assert state.values.dtype == np.float32
        assert got.dtype == np.uint8


def test_what_it_gives_is_the_caller_s() -> None:
    state = prf.EmaState()
    first = state.update(FRAMES[0])
    first[:] = 0
    np.testing.assert_array_equal(state.state, FRAMES[0])


def test_a_reset_begins_anew_with_another_size() -> None:
    state = prf.EmaState()
    for _ in range(2):
        assert state.state.shape == state.values.shape == (0, 0)
        for frame in FRAMES[:3]:
            state.update(frame)
        state.reset()
    np.testing.assert_array_equal(state.update(FRAMES[5, :7]), FRAMES[5, :7])


def test_a_frame_of_another_size_is_refused_and_changes_nothing() -> None:
    state = prf.EmaState()
    state.update(FRAMES[0])
    message = "frame: got a frame of 30x19 px, expected 30x20 as the frames before it"
    refuse(lambda: state.update(FRAMES[1, 1:]), ValueError, message)
    np.testing.assert_array_equal(state.state, FRAMES[0])


@pytest.mark.parametrize("duplicate", COPIES)
def test_a_copy_goes_on_by_itself(duplicate: str) -> None:
    state, together = prf.EmaState(decay=0.6), prf.EmaState(decay=0.6)
    for count in range(4):
        other: prf.EmaState = COPIES[duplicate](state)
        assert other.decay == 0.6
        np.testing.assert_array_equal(other.values, state.values)
        np.testing.assert_array_equal(other.update(FRAMES[count]), together.update(FRAMES[count]))
        state.update(FRAMES[count])


def test_a_state_may_be_an_array_of_any_order() -> None:
    state = prf.EmaState()
    for frame in FRAMES[:3]:
        state.update(frame)
    other = prf.EmaState()
    other.__setstate__(np.asfortranarray(state.values))
    np.testing.assert_array_equal(other.values, state.values)


def test_it_says_what_it_is() -> None:
    assert repr(prf.EmaState()) == "EmaState(decay=0.7)"
    assert prf.EmaState(decay=float(np.float32(0.25))).decay == 0.25


@pytest.mark.parametrize(
    ("decay", "error", "message"),
    [
        (1, ValueError, "decay: got 1, expected at least 0 and below 1"),
        (-0.1, ValueError, "decay: got -0.1, expected at least 0 and below 1"),
        (float("nan"), ValueError, "decay: got NaN, expected at least 0 and below 1"),
        ("0.7", TypeError, "decay: got str, expected a float"),
        (None, TypeError, "decay: got NoneType, expected a float"),
    ],
)
def test_a_decay_out_of_range_is_refused(decay: Any, error: type[Exception], message: str) -> None:
    refuse(lambda: prf.EmaState(decay=decay), error, message)


@pytest.mark.parametrize(
    ("values", "error"),
    [
        (np.full((2, 3), 256, np.float32), ValueError),
        (np.full((2, 3), np.nan, np.float32), ValueError),
        (np.zeros((0, 3), np.float32), ValueError),
        (np.zeros((2, 3)), TypeError),
        (b"state", TypeError),
    ],
)
def test_a_state_that_is_none_is_refused(values: Any, error: type[Exception]) -> None:
    refuse(lambda: prf.EmaState().__setstate__(values), error)
