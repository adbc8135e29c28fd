"""Template matching, against scikit-image and OpenCV."""

from typing import Any, Literal, TypeAlias

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from pictures import PICTURES, Bytes, natural
from refusal import refuse
from untyped import skimage_feature

import prf

Method: TypeAlias = Literal["ccorr-normed", "ccoeff-normed"]
OPENCV: dict[Method, int] = {"ccorr-normed": cv2.TM_CCORR_NORMED, "ccoeff-normed": cv2.TM_CCOEFF_NORMED}
IMAGE = natural(60, 83)
SIZES = [(1, 1), (3, 5), (9, 12), (24, 31), (40, 83), (60, 83)]


def template(height: int, width: int) -> Bytes:
    return IMAGE[-height:, -width:]


@pytest.mark.parametrize("size", SIZES[1:])
def test_the_default_is_scikit_image_s(size: tuple[int, int]) -> None:
    expected = skimage_feature.match_template(IMAGE, template(*size))
    got = prf.match_template(IMAGE, template(*size))
    assert got.shape == expected.shape == (60 - size[0] + 1, 83 - size[1] + 1)
    assert got.dtype == np.float32
    np.testing.assert_allclose(got, expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("method", OPENCV)
def test_each_method_is_opencv_s(method: Method, size: tuple[int, int]) -> None:
    expected = cv2.matchTemplate(IMAGE, template(*size), OPENCV[method])
    got = prf.match_template(IMAGE, template(*size), method=method)
    if size == (1, 1) and method == "ccoeff-normed":
        expected = np.zeros_like(expected)  # a flat template fits nowhere here, and everywhere there
    np.testing.assert_allclose(got, expected, rtol=0, atol=1e-4)


@pytest.mark.parametrize("method", OPENCV)
def test_masks_are_opencv_s(method: Method) -> None:
    y, x = np.mgrid[:15, :19]
    mask = np.hypot(y - 7, x - 9) < 7
    expected = cv2.matchTemplate(IMAGE, template(15, 19), OPENCV[method], mask=mask.astype(np.uint8))
    for form in (
        mask,
        mask.astype(np.uint8),
        np.where(mask, np.uint8(255), np.uint8(0)),
        np.asfortranarray(mask),
    ):
        got = prf.match_template(IMAGE, template(15, 19), mask=form, method=method)
        np.testing.assert_allclose(got, expected, rtol=0, atol=1e-4)
    unmasked = prf.match_template(IMAGE, template(15, 19), mask=None, method=method)
    assert np.abs(unmasked - expected).max() > 1e-2


def test_x_and_y_are_where_the_template_lies() -> None:
    result = prf.match_template(IMAGE, IMAGE[30:39, 50:62])
    y, x = np.unravel_index(result.argmax(), result.shape)
    assert (int(x), int(y)) == (50, 30)
    assert result[y, x] == pytest.approx(1, abs=1e-4)


def test_flat_windows_score_0() -> None:
    image = PICTURES["boxes"]
    scores = prf.match_template(image, image[8:20, 4:20])
    assert np.isfinite(scores).all()
    flat = np.lib.stride_tricks.sliding_window_view(image, (12, 16)).std(axis=(2, 3)) == 0
    assert flat.any()
    assert (scores[flat] == 0).all()


def test_what_can_not_be_matched_is_refused() -> None:
    call: Any = prf.match_template
    small = template(9, 12)
    for size in [(61, 83), (60, 84)]:
        message = f"image: a template of {size[1]}x{size[0]} px doesn't fit into a frame of 83x60 px"
        refuse(lambda: call(IMAGE, np.ones(size, np.uint8)), ValueError, message)
    refuse(lambda: call(IMAGE, small, mask=small[1:]), ValueError, "mask: got 12x8 px, expected 12x9 px")
    refuse(
        lambda: call(IMAGE, small, mask=small * 0),
        ValueError,
        "mask: got only zeros, expected a pixel that counts",
    )
    refuse(
        lambda: call(IMAGE, small, mask=small / 255),
        TypeError,
        "mask: got an array of float64, expected uint8",
    )
    refuse(lambda: call(IMAGE, small, mask="mask.png"), TypeError, "mask: got str, expected a NumPy array")
    refuse(
        lambda: call(IMAGE, small, method="TM_CCOEFF_NORMED"),
        ValueError,
        "method: got 'TM_CCOEFF_NORMED', expected one of",
        "ccoeff-normed",
    )
    refuse(lambda: call(IMAGE, small, method=5), TypeError, "method: got int, expected a str")
    refuse(lambda: call(IMAGE / 255, small), TypeError, "image: got an array of float64, expected uint8")
    refuse(
        lambda: call(IMAGE, [[1]]),
        TypeError,
        "template: got list, expected a NumPy array of shape (height, width)",
    )


def test_a_mask_of_bools_is_as_wide_as_it_looks() -> None:
    mask: NDArray[np.bool_] = np.zeros((9, 24), bool)
    mask[:, ::4] = True
    expected = prf.match_template(IMAGE, template(9, 12), mask=np.ascontiguousarray(mask[:, ::2]))
    np.testing.assert_array_equal(prf.match_template(IMAGE, template(9, 12), mask=mask[:, ::2]), expected)
