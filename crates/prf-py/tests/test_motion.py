"""Motion templates, all at once and frame by frame."""

from typing import Any

import numpy as np
import pytest
import reference
from copies import COPIES
from pictures import Bytes, moving
from refusal import refuse

import prf

FRAMES = moving(12, 40, 50)
OPTIONS: list[dict[str, Any]] = [
    {},
    {"threshold": 0},
    {"threshold": 254},
    {"tau_start": 0.3, "tau_step": 0.3, "delta_divisor": 4},
    {"duration": 0.8},
    {"duration": 0},
    {"duration": 1e9, "threshold": 3},
    {"skip_still": True},
]


def with_pauses(frames: Bytes) -> Bytes:
    return np.repeat(frames, [1, 3, 1, 2, 1, 1, 4, 1, 1, 1, 2, 3], axis=0)


@pytest.mark.parametrize("options", OPTIONS)
def test_the_template_is_as_defined(options: dict[str, Any]) -> None:
    for frames in (FRAMES, with_pauses(FRAMES), FRAMES[:2], FRAMES[:1]):
        got = prf.motion_template(frames, **options)
        assert got.shape == (40, 50)
        assert got.dtype == np.uint8
        # A half may be rounded either way.
        difference = got.astype(int) - reference.motion_template(frames, **options)
        assert np.abs(difference).max() <= 1
        np.testing.assert_array_equal(got == 0, reference.motion_history(frames, **options)[0] == 0)


@pytest.mark.parametrize("options", OPTIONS)
def test_frame_by_frame_it_is_the_same(options: dict[str, Any]) -> None:
    frames = with_pauses(FRAMES)
    motion = prf.MotionTemplate(**options)
    for count, frame in enumerate(frames, 1):
        template = motion.update(frame)
        np.testing.assert_array_equal(template, prf.motion_template(frames[:count], **options))
        np.testing.assert_array_equal(template, motion.template)
        history, tau = reference.motion_history(frames[:count], **options)
        np.testing.assert_array_equal(motion.history, history.astype(np.float32))
        assert motion.tau == pytest.approx(tau, rel=1e-6)
        np.testing.assert_array_equal(motion.energy, np.where(history > 0, 255, 0))
        assert motion.has_motion == bool(history.any())
    moved = (np.abs(np.diff(frames.astype(int), axis=0)) > options.get("threshold", 30)).any(axis=(1, 2))
    assert motion.iterations == (moved.sum() if "skip_still" in options else len(frames) - 1)


def test_a_pause_is_passed_over() -> None:
    expected = prf.motion_template(FRAMES, skip_still=True)
    np.testing.assert_array_equal(prf.motion_template(with_pauses(FRAMES), skip_still=True), expected)
    np.testing.assert_array_equal(prf.motion_template(FRAMES), expected)
    assert (prf.motion_template(with_pauses(FRAMES)) != expected).any()


def test_nothing_is_remembered_before_the_first_frame_and_after_a_reset() -> None:
    motion = prf.MotionTemplate()
    for _ in range(2):
        assert motion.template.shape == motion.energy.shape == motion.history.shape == (0, 0)
        assert (motion.tau, motion.iterations, motion.has_motion) == (0, 0, False)
        for frame in FRAMES:
            motion.update(frame)
        assert motion.has_motion
        motion.reset()
    motion.update(FRAMES[0, :10])  # of another size
    assert motion.template.shape == (10, 50)
    assert prf.motion_template(FRAMES[:0]).shape == (40, 50)


def test_a_frame_of_another_size_is_refused_and_changes_nothing() -> None:
    motion = prf.MotionTemplate()
    for frame in FRAMES[:5]:
        motion.update(frame)
    before = motion.template
    message = "frame: got a frame of 50x39 px, expected 50x40 as the frames before it"
    refuse(lambda: motion.update(FRAMES[5, 1:]), ValueError, message, "reset")
    np.testing.assert_array_equal(motion.template, before)


@pytest.mark.parametrize("duplicate", COPIES)
def test_a_copy_goes_on_by_itself(duplicate: str) -> None:
    motion = prf.MotionTemplate(duration=0.7, threshold=20)
    for count in range(4):
        other: prf.MotionTemplate = COPIES[duplicate](motion)
        assert repr(other) == repr(motion)
        np.testing.assert_array_equal(other.history, motion.history)
        for frame in FRAMES[count : count + 3]:
            other.update(frame)
        expected = prf.motion_template(FRAMES[: count + 3], duration=0.7, threshold=20)
        np.testing.assert_array_equal(other.template, expected)
        motion.update(FRAMES[count])


def test_it_says_what_it_is() -> None:
    shown = "MotionTemplate(threshold=30, tau_start=0.1, tau_step=0.4, delta_divisor=3.0, skip_still=False)"
    assert repr(prf.MotionTemplate()) == shown
    assert "duration=0.25, skip_still=True)" in repr(prf.MotionTemplate(duration=0.25, skip_still=True))


@pytest.mark.parametrize("state", [b"", b"prf", bytes(100)])
def test_a_state_that_is_none_is_refused(state: bytes) -> None:
    refuse(lambda: prf.MotionTemplate().__setstate__(state), ValueError, "state: ")


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"threshold": 255}, ValueError, "threshold: got 255, expected 0 to 254"),
        ({"threshold": 256}, ValueError, "threshold: got 256, expected an int of 0 to 254"),
        ({"threshold": -1}, ValueError, "threshold: got -1, expected an int of 0 to 254"),
        ({"threshold": 30.0}, TypeError, "threshold: got float, expected an int of 0 to 254"),
        ({"tau_start": 0}, ValueError, "tau_start: got 0, expected 0.001 to 1000"),
        ({"tau_step": float("nan")}, ValueError, "tau_step: got NaN, expected 0.001 to 1000"),
        ({"tau_step": "1"}, TypeError, "tau_step: got str, expected a float"),
        ({"delta_divisor": 0}, ValueError, "delta_divisor: got 0, expected a finite number above 0"),
        ({"duration": -1}, ValueError, "duration: got -1, expected a finite number of at least 0"),
        (
            {"duration": 1, "delta_divisor": 3},
            ValueError,
            "got both delta_divisor and duration, expected one of them",
        ),
        ({"skip_still": 1}, TypeError, "skip_still: got int, expected a bool"),
        ({"tau": 1}, TypeError, "got an unexpected keyword argument 'tau'"),
    ],
)
def test_options_out_of_range_are_refused(
    options: dict[str, Any], error: type[Exception], message: str
) -> None:
    for call in (
        lambda: prf.motion_template(FRAMES, **options),
        lambda: prf.MotionTemplate(**options),
        lambda: prf.MotionGoal(FRAMES, **options),
    ):
        refuse(call, error, message)
