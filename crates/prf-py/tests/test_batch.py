"""Many pictures at once give what each of them gives, however many threads there are."""

from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pictures import Bytes, moving, natural
from refusal import refuse
from untyped import numpy_ma

import prf

FRAMES = moving(23, 48, 60)
GOAL = natural(40, 36)
PART = FRAMES[7, 20:34, 10:31]
Batch = Callable[..., NDArray[Any]]
Single = Callable[[Bytes], Any]


def episode(frames: Bytes, threads: int | None = None, **options: Any) -> NDArray[np.float32]:
    return prf.MotionGoal(FRAMES).rewards(frames, threads=threads, **options)


LONG: dict[str, Any] = {"block_cells": 2, "cell_px": 5, "feature_vector": False}
MASKED: dict[str, Any] = {"mask": PART > 7, "method": "ccorr-normed"}
SCALED: dict[str, Any] = {"cell_px": 4, "scale": "none"}
PAIRS: dict[str, tuple[Batch, Single]] = {
    "hog": (prf.hog_batch, prf.hog),
    "hog, long": (partial(prf.hog_batch, **LONG), partial(prf.hog, **LONG)),
    "crop_box": (prf.crop_box_batch, prf.crop_box),
    "match_template": (
        partial(prf.match_template_batch, template=PART),
        partial(prf.match_template, template=PART),
    ),
    "match_template, masked": (
        partial(prf.match_template_batch, template=PART, **MASKED),
        partial(prf.match_template, template=PART, **MASKED),
    ),
    "reward": (partial(prf.reward_batch, GOAL, **SCALED), partial(prf.reward, GOAL, **SCALED)),
    "distance": (partial(prf.distance_batch, GOAL), partial(prf.distance, GOAL)),
    "DirectGoal": (prf.DirectGoal(GOAL).rewards, prf.DirectGoal(GOAL).reward),
    "WindowGoal": (prf.WindowGoal(PART).rewards, prf.WindowGoal(PART).reward),
    "MotionGoal": (episode, prf.MotionGoal(FRAMES).reward),
}


@pytest.mark.parametrize("name", PAIRS)
def test_a_batch_is_its_pictures(name: str) -> None:
    batch, single = PAIRS[name]
    expected = np.array([single(frame) for frame in FRAMES])
    for threads in (None, 1, 2, 3, 8, 1024):
        got = batch(FRAMES, threads=threads)
        assert got.dtype == (np.int64 if name == "crop_box" else np.float32)
        np.testing.assert_array_equal(got, expected)
    if name == "MotionGoal":
        return  # whose frames count in their order only
    gaps = np.repeat(FRAMES, 2, axis=2)[::-1, :, ::2]
    np.testing.assert_array_equal(batch(gaps), expected[::-1])
    large = np.tile(FRAMES, (40, 1, 1))  # so many that there is something to share
    np.testing.assert_array_equal(batch(large), np.concatenate([expected] * 40))


@pytest.mark.parametrize("name", PAIRS)
def test_no_pictures_give_no_results(name: str) -> None:
    batch, _ = PAIRS[name]
    full, none = batch(FRAMES[:1]), batch(FRAMES[:0])
    assert none.shape == (0, *full.shape[1:])
    assert none.dtype == full.dtype
    assert batch(FRAMES[:0], threads=7).shape == none.shape


@pytest.mark.parametrize("name", PAIRS)
def test_what_is_no_batch_is_refused(name: str) -> None:
    batch: Any = PAIRS[name][0]
    given = "images" if name.startswith(("hog", "crop", "match")) else "frames"
    shape = "(count, height, width)"
    refuse(
        lambda: batch(FRAMES[0]),
        ValueError,
        f"{given}: got shape (48, 60), expected {shape} with sides of 1 to",
    )
    refuse(lambda: batch(FRAMES[None]), ValueError, f"{given}: got shape (1, 23, 48, 60), expected {shape}")
    refuse(lambda: batch(FRAMES[:, :0]), ValueError, f"{given}: got shape (23, 0, 60), expected {shape}")
    refuse(lambda: batch(np.zeros((2, 16385, 1), np.uint8)), ValueError, f"{given}: got shape (2, 16385, 1)")
    refuse(
        lambda: batch(list(FRAMES)), TypeError, f"{given}: got list, expected a NumPy array of shape {shape}"
    )
    refuse(
        lambda: batch(FRAMES.astype(np.int32)), TypeError, f"{given}: got an array of int32, expected uint8"
    )
    refuse(lambda: batch(numpy_ma.masked_less(FRAMES, 9)), TypeError, f"{given}: got a masked array")
    refuse(lambda: batch(FRAMES, thread=2), TypeError, "got an unexpected keyword argument 'thread'")
    for threads in (0, 1025):
        refuse(
            lambda: batch(FRAMES, threads=threads), ValueError, f"threads: got {threads}, expected 1 to 1024"
        )
    refuse(lambda: batch(FRAMES, threads=-1), ValueError, "threads: got -1, expected an int of at least 1")
    refuse(lambda: batch(FRAMES, threads=2.0), TypeError, "threads: got float, expected an int of at least 1")


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_the_first_bad_picture_is_named_however_many_threads_there_are(dtype: type[np.floating[Any]]) -> None:
    images = np.zeros((200, 20, 20), dtype)
    for at in (71, 72, 199):
        images[at, 3, 5] = np.nan
    for threads in (None, 1, 2, 64):
        message = "images[71]: pixel (5, 3) is NaN, expected a finite number"
        refuse(lambda: prf.hog_batch(images, threads=threads), ValueError, message)


@pytest.mark.parametrize("name", ["hog", "crop_box", "match_template", "reward", "DirectGoal"])
def test_more_than_memory_is_a_memory_error(name: str) -> None:
    huge = np.broadcast_to(FRAMES[0], (1 << 40, 48, 60))
    with pytest.raises(MemoryError):
        PAIRS[name][0](huge)


def test_floats_of_every_form_give_the_same() -> None:
    images = FRAMES.astype(np.float32) / np.float32(255)
    expected = np.stack([prf.hog(image, cell_px=6) for image in images])
    np.testing.assert_array_equal(prf.hog_batch(images, cell_px=6), expected)
    np.testing.assert_array_equal(prf.hog_batch(np.asfortranarray(images), cell_px=6), expected)
    np.testing.assert_array_equal(prf.hog_batch(images.astype(np.float64), cell_px=6), expected)
