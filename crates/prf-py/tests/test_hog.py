import itertools
from typing import Any, Literal, TypeAlias

import numpy as np
import pytest
import reference
from numpy.typing import NDArray
from pictures import PICTURES, natural
from untyped import skimage_feature

import prf

Norm: TypeAlias = Literal["none", "l1", "l1-sqrt", "l2", "l2-hys"]
SKIMAGE: dict[Norm, str] = {"l1": "L1", "l1-sqrt": "L1-sqrt", "l2": "L2", "l2-hys": "L2-Hys"}


@pytest.mark.parametrize("picture", PICTURES)
@pytest.mark.parametrize("norm", SKIMAGE)
def test_every_norm_and_block_size_equals_scikit_image(picture: str, norm: Norm) -> None:
    image = PICTURES[picture]
    for block, cell, bins in itertools.product((1, 2, 3), (1, 5, 8), (7, 9)):
        expected = skimage_feature.hog(image / 255, bins, (cell, cell), (block, block), SKIMAGE[norm], feature_vector=False)
        got = prf.hog(image, orientations=bins, cell_px=cell, block_cells=block, norm=norm, feature_vector=False)
        assert got.shape == expected.shape
        np.testing.assert_allclose(got, expected, rtol=0, atol=1e-5, err_msg=f"{block=} {cell=} {bins=}")


@pytest.mark.parametrize("dtype", ["f4", "f8"])
def test_floats_equal_scikit_image(dtype: str) -> None:
    image: NDArray[Any] = np.random.default_rng(2).random((45, 62)).astype(dtype)
    expected = skimage_feature.hog(image, 9, (6, 6), (2, 2), "L2-Hys")
    np.testing.assert_allclose(prf.hog(image, cell_px=6, block_cells=2, norm="l2-hys"), expected, rtol=0, atol=1e-5)


@pytest.mark.parametrize("signed", [False, True])
@pytest.mark.parametrize("picture", PICTURES)
def test_signed_and_unsigned_bins_are_as_defined(picture: str, signed: bool) -> None:
    image = PICTURES[picture]
    expected = reference.hog(image, 6, signed=signed)
    got = prf.hog(image, cell_px=6, signed=signed, feature_vector=False)
    np.testing.assert_allclose(got[:, :, 0, 0], expected, rtol=0, atol=1e-5)


def test_without_a_norm_features_are_mean_gradients() -> None:
    ramp = np.tile(np.arange(0, 100, 10, dtype=np.uint8), (10, 1))
    got = prf.hog(ramp, cell_px=10, orientations=3, norm="none")
    np.testing.assert_allclose(got, [20 / 255 * 8 / 10, 0, 0], rtol=1e-6)


def test_the_flat_form_is_the_long_one_in_order() -> None:
    image = natural(33, 41)
    blocks = prf.hog(image, cell_px=4, block_cells=3, orientations=5, feature_vector=False)
    flat = prf.hog(image, cell_px=4, block_cells=3, orientations=5)
    assert blocks.shape == (6, 8, 3, 3, 5)
    assert blocks.dtype == flat.dtype == np.float32
    np.testing.assert_array_equal(flat, blocks.ravel())


def test_defaults_are_those_documented() -> None:
    image = natural(100, 120)
    expected = prf.hog(image, orientations=9, signed=False, cell=0.03, block_cells=1, norm="l2", feature_vector=True)
    np.testing.assert_array_equal(prf.hog(image), expected)
    np.testing.assert_array_equal(prf.hog(image, cell_px=3), expected)


def test_a_result_belongs_to_the_caller() -> None:
    image = natural(20, 20)
    first = prf.hog(image)
    kept = first.copy()
    prf.hog(255 - image)
    np.testing.assert_array_equal(first, kept)
    first[:] = 0  # and may be written to
    np.testing.assert_array_equal(prf.hog(image), kept)
