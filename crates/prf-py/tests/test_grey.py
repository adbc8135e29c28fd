"""Colours to grey, as others do it."""

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image
from pictures import natural
from untyped import numpy_ma

import prf

Bytes = NDArray[np.uint8]

COLOURS: Bytes = np.random.default_rng(2).integers(0, 256, (37, 53, 4), np.uint8)


def test_grey_is_pillow_s() -> None:
    rgb = np.ascontiguousarray(COLOURS[..., :3])
    np.testing.assert_array_equal(prf.to_grey(rgb), np.asarray(Image.fromarray(rgb).convert("L")))


def test_grey_by_hand() -> None:
    rgb = np.array([[[255, 0, 0], [0, 255, 0], [0, 0, 255], [10, 200, 90], [255, 255, 255]]], np.uint8)
    assert prf.to_grey(rgb).tolist() == [[76, 150, 29, 131, 255]]


def test_what_is_transparent_lies_on_black() -> None:
    alpha = COLOURS[..., 3].astype(np.float64)
    expected = np.round(prf.to_grey(COLOURS[..., :3]) * alpha / 255).astype(np.uint8)
    np.testing.assert_array_equal(prf.to_grey(COLOURS), expected)


@pytest.mark.parametrize("form", ["columns first", "backwards and spaced", "transposed"])
def test_arrays_may_have_any_form(form: str) -> None:
    rgb = COLOURS[..., :3]
    forms = {"columns first": np.asfortranarray(rgb), "backwards and spaced": rgb[::-1, ::2], "transposed": rgb.swapaxes(0, 1)}
    other = forms[form]
    np.testing.assert_array_equal(prf.to_grey(other), prf.to_grey(np.ascontiguousarray(other)))


def test_grey_stays_grey() -> None:
    grey = natural(31, 45)
    for image in (grey, grey[..., np.newaxis], np.repeat(grey[..., np.newaxis], 3, axis=2)):
        result = prf.to_grey(image)
        np.testing.assert_array_equal(result, grey)
        result[:] = 0
        assert image.any()


@pytest.mark.parametrize("size", [(31, 45), (90, 60), (20, 20), (7, 100), (1, 1)])
def test_pictures_are_brought_to_a_size_as_by_pillow(size: tuple[int, int]) -> None:
    grey = natural(31, 45)
    got = prf.to_grey(grey, size=size)
    expected = Image.fromarray(grey).resize((size[1], size[0]), Image.Resampling.BILINEAR)
    assert np.abs(got.astype(int) - np.asarray(expected).astype(int)).max() <= 1  # Pillow rounds its weights
    if size[0] == size[1]:
        np.testing.assert_array_equal(prf.to_grey(grey, size=size[0]), got)
    flat = prf.to_grey(np.full((9, 13, 3), 77, np.uint8), size=size)
    np.testing.assert_array_equal(flat, np.full(size, 77))


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"image": None}, TypeError, "image: got NoneType, expected a NumPy array"),
        ({"image": np.zeros((9, 9))}, TypeError, "image: got an array of float64, expected uint8; for floats"),
        ({"image": np.zeros((9, 9, 3))}, TypeError, "image: got an array of float64, expected uint8; for floats"),
        ({"image": numpy_ma.zeros((9, 9, 3), np.uint8)}, TypeError, "image: got a masked array, expected a plain one"),
        ({"image": numpy_ma.zeros((9, 9), np.uint8)}, TypeError, "image: got a masked array, expected a plain one"),
        ({"image": np.zeros((9, 9, 2), np.uint8)}, ValueError, r"image: got shape \(9, 9, 2\), expected \(height, width\),"),
        ({"image": np.zeros((9, 9, 5), np.uint8)}, ValueError, r"image: got shape \(9, 9, 5\), expected"),
        ({"image": np.zeros((0, 9, 3), np.uint8)}, ValueError, r"image: got shape \(0, 9, 3\), expected"),
        ({"image": np.zeros((16385, 1, 3), np.uint8)}, ValueError, r"image: got shape \(16385, 1, 3\), expected"),
        ({"image": np.zeros((2, 9, 9, 3), np.uint8)}, ValueError, r"image: got shape \(2, 9, 9, 3\), expected"),
        ({"image": np.zeros(9, np.uint8)}, ValueError, r"image: got shape \(9\), expected"),
        ({"size": (0, 9)}, ValueError, r"size: got \(0, 9\), expected a side or \(height, width\) of 1 to 16384 pixels"),
        ({"size": (9, -1)}, ValueError, r"size: got \(9, -1\), expected"),
        ({"size": (9, 16385)}, ValueError, r"size: got \(9, 16385\), expected"),
        ({"size": (9, 2**70)}, ValueError, r"size: got \(9, 1180591620717411303424\), expected"),
        ({"size": 0}, ValueError, "size: got 0, expected a side"),
        ({"size": 2**70}, ValueError, "size: got 1180591620717411303424, expected a side"),
        ({"size": 84.0}, TypeError, "size: got 84.0, expected a side"),
        ({"size": (9.0, 9)}, TypeError, r"size: got \(9.0, 9\), expected"),
        ({"scale": 2}, TypeError, "unexpected keyword argument 'scale'"),
    ],
)
def test_what_is_no_picture_is_refused(arguments: dict[str, Any], error: type[Exception], message: str) -> None:
    given: dict[str, Any] = {"image": natural(9, 9), **arguments}
    with pytest.raises(error, match=message):
        prf.to_grey(**given)
