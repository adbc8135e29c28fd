"""Crops, against OpenCV and NumPy."""

import cv2
import numpy as np
import pytest
from pictures import PICTURES, Bytes, boxes, natural

import prf


def spots(height: int, width: int, seed: int) -> Bytes:
    """A few pixels that are not black."""
    rng = np.random.default_rng(seed)
    image = np.zeros((height, width), np.uint8)
    for _ in range(rng.integers(1, 4)):
        image[rng.integers(height), rng.integers(width)] = rng.integers(1, 256)
    return image


@pytest.mark.parametrize("seed", range(40))
def test_the_box_is_opencv_s(seed: int) -> None:
    height, width = np.random.default_rng(seed).integers(1, 150, 2)
    image = spots(int(height), int(width), seed)
    assert prf.crop_box(image) == cv2.boundingRect(image)


def test_the_box_of_a_black_picture_is_the_whole_picture() -> None:
    assert prf.crop_box(np.zeros((7, 9), np.uint8)) == prf.Rect(x=0, y=0, width=9, height=7)


@pytest.mark.parametrize("picture", PICTURES)
def test_a_crop_is_a_view_of_the_box(picture: str) -> None:
    image = PICTURES[picture]
    crop, box = prf.crop(image), prf.crop_box(image)
    assert np.shares_memory(crop, image)
    assert crop.shape == (box.height, box.width)
    np.testing.assert_array_equal(crop, image[box.y : box.y + box.height, box.x : box.x + box.width])
    assert np.count_nonzero(crop) == np.count_nonzero(image)


def test_a_crop_of_a_view_with_gaps_is_a_view_too() -> None:
    wide = np.zeros((60, 80), np.uint8)
    image = wide[::2, ::-2]
    image[4:9, 3:20] = 7
    crop = prf.crop(image)
    assert np.shares_memory(crop, wide)
    assert crop.shape == (5, 17)
    assert (crop == 7).all()


def test_a_crop_of_a_crop_is_the_same() -> None:
    crop = prf.crop(boxes(64, 47))
    np.testing.assert_array_equal(prf.crop(crop), crop)


def test_rewards_compare_crops() -> None:
    goal, frame = boxes(50, 40), natural(44, 37)
    assert prf.distance(goal, frame) == prf.distance(prf.crop(goal), prf.crop(frame))
