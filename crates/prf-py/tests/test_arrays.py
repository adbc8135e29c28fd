"""Arrays of every kind work or are refused with what was got and what was expected."""

import itertools
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pictures import boxes, natural
from refusal import refuse

import prf

IMAGE = natural(24, 36)


def spaced(array: NDArray[Any]) -> NDArray[Any]:
    wide = np.zeros((array.shape[0] * 2, array.shape[1] * 3), array.dtype)
    wide[::2, ::3] = array
    return wide[::2, ::3]


def misaligned(array: NDArray[Any]) -> NDArray[Any]:
    memory = np.zeros(array.nbytes + 1, np.uint8)
    memory[1:] = np.frombuffer(array.tobytes(), np.uint8)
    return np.frombuffer(memory, array.dtype, offset=1).reshape(array.shape)


def read_only(array: NDArray[Any]) -> NDArray[Any]:
    copy = array.copy()
    copy.flags.writeable = False
    return copy


FORMS: dict[str, Callable[[NDArray[Any]], NDArray[Any]]] = {
    "columns first": np.asfortranarray,
    "spaced": spaced,
    "backwards": lambda array: np.ascontiguousarray(array[::-1, ::-1])[::-1, ::-1],
    "transposed": lambda array: np.ascontiguousarray(array.T).T,
    "a part": lambda array: np.pad(array, 5)[5:-5, 5:-5],
    "read-only": read_only,
    "read-only and spaced": lambda array: read_only(np.repeat(array, 2, axis=1))[:, ::2],
    "misaligned": misaligned,
}


@pytest.mark.parametrize("dtype", [np.uint8, np.float32, np.float64])
@pytest.mark.parametrize("form", FORMS)
def test_only_the_pixels_count(form: str, dtype: type[np.generic]) -> None:
    image: NDArray[Any] = IMAGE.astype(dtype) if dtype is np.uint8 else (IMAGE / 255).astype(dtype)
    other = FORMS[form](image)
    np.testing.assert_array_equal(other, image)
    np.testing.assert_array_equal(prf.hog(other, cell_px=4), prf.hog(image, cell_px=4))


@pytest.mark.parametrize("form", FORMS)
def test_goals_and_frames_may_be_of_any_form(form: str) -> None:
    goal, frame = boxes(40, 30), natural(44, 28)
    expected = prf.distance(goal, frame)
    assert prf.distance(FORMS[form](goal), FORMS[form](frame)) == expected


def test_only_arrays_with_gaps_are_copied_and_once(monkeypatch: pytest.MonkeyPatch) -> None:
    copies: list[object] = []
    array = np.array

    def counted(*arguments: Any, **options: Any) -> Any:
        copies.append(arguments)
        return array(*arguments, **options)

    gaps = spaced(IMAGE)
    monkeypatch.setattr(np, "array", counted)
    prf.hog(IMAGE)
    prf.reward(IMAGE, IMAGE)
    assert len(copies) == 0
    prf.hog(gaps)
    prf.reward(gaps, IMAGE)
    assert len(copies) == 2


def test_one_value_for_all_pixels_is_a_picture() -> None:
    flat = np.broadcast_to(np.uint8(7), (20, 30))
    np.testing.assert_array_equal(prf.hog(flat), np.zeros(20 * 30 * 9, np.float32))


@pytest.mark.parametrize(
    "dtype", ["bool", "int8", "int64", "uint16", "float16", "complex64", ">f4", "O", "U3", "M8[s]", [("x", "u1")]]
)
def test_other_dtypes_are_refused(dtype: Any) -> None:
    image: Any = np.zeros((9, 9), dtype)
    refuse(lambda: prf.hog(image), TypeError, f"image: got an array of {image.dtype}", "uint8, float32 or float64")
    refuse(lambda: prf.reward(IMAGE, image), TypeError, f"frame: got an array of {image.dtype}", "expected uint8")
    refuse(lambda: prf.distance(image, IMAGE), TypeError, f"goal: got an array of {image.dtype}", "expected uint8")


@pytest.mark.parametrize("image", [None, 3, "picture.png", [[1, 2], [3, 4]], memoryview(b"1234"), np.uint8(4)])
def test_what_is_no_array_is_refused(image: Any) -> None:
    got = type(image).__name__
    refuse(lambda: prf.hog(image), TypeError, f"image: got {got}, expected a NumPy array")
    refuse(lambda: prf.reward(image, IMAGE), TypeError, f"goal: got {got}, expected a NumPy array")
    refuse(lambda: prf.reward(IMAGE, image), TypeError, f"frame: got {got}, expected a NumPy array")


@pytest.mark.parametrize(
    "shape", [(), (9,), (0, 0), (0, 9), (9, 0), (1, 9, 9), (9, 9, 3), (9, 9, 4), (16385, 1), (1, 16385)]
)
def test_other_shapes_are_refused(shape: tuple[int, ...]) -> None:
    image = np.zeros(shape, np.uint8)
    expected = "expected (height, width) with sides of 1 to 16384"
    got = f"got shape ({', '.join(map(str, shape))})"
    refuse(lambda: prf.hog(image), ValueError, f"image: {got}", expected)
    refuse(lambda: prf.reward(image, IMAGE), ValueError, f"goal: {got}", expected)
    refuse(lambda: prf.reward(IMAGE, image), ValueError, f"frame: {got}", expected)


def test_colours_are_told_what_to_do() -> None:
    refuse(lambda: prf.hog(np.zeros((9, 9, 3), np.uint8)), ValueError, "turn colours to grey first")


def test_a_picture_that_takes_no_memory_itself_is_refused_when_huge() -> None:
    for dtype in (np.uint8, np.float32, np.float64):
        huge = np.broadcast_to(np.zeros((), dtype), (1 << 30, 1 << 20))
        refuse(lambda huge=huge: prf.hog(huge), ValueError, "got shape (1073741824, 1048576)")


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e30, 1e300])
def test_pixels_that_are_no_numbers_are_refused(value: float) -> None:
    image = np.zeros((9, 12))
    image[4, 7] = value
    refuse(lambda: prf.hog(image), ValueError, "image: pixel (7, 4) is ", "expected a finite number")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # 1e300 as a float32
        floats = image.astype(np.float32)
    refuse(lambda: prf.hog(floats), ValueError, "image: pixel (7, 4) is ", "expected a finite number")


def test_the_largest_picture_works() -> None:
    line = np.full((1, 16384), 9, np.uint8)
    assert prf.hog(line).shape == (16384 * 9,)
    for goal, frame in itertools.product([line, line.T], repeat=2):
        assert prf.reward(goal, frame, cell_px=1) == 1.0
