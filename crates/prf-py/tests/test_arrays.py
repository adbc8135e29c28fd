"""Arrays of every kind work or are refused with what was got and what was expected."""

import itertools
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from numpy.typing import NDArray
from pictures import natural
from refusal import refuse
from untyped import numpy_ma

import prf

IMAGE = natural(24, 36)
PART = IMAGE[3:9, 2:9].copy()


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


# Calls with one array of bytes, and what the array is called.
BYTES: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "reward, goal": ("goal", lambda array: prf.reward(array, IMAGE)),
    "reward, frame": ("frame", lambda array: prf.reward(IMAGE, array)),
    "distance, goal": ("goal", lambda array: prf.distance(array, IMAGE)),
    "distance, frame": ("frame", lambda array: prf.distance(IMAGE, array)),
    "reward_batch, goal": ("goal", lambda array: prf.reward_batch(array, IMAGE[None])),
    "crop": ("image", prf.crop),
    "crop_box": ("image", prf.crop_box),
    "match_template, image": ("image", lambda array: prf.match_template(array, PART)),
    "match_template, template": ("template", lambda array: prf.match_template(IMAGE, array)),
    "match_template_batch, template": (
        "template",
        lambda array: prf.match_template_batch(IMAGE[None], array),
    ),
    "MotionTemplate": ("frame", lambda array: prf.MotionTemplate().update(array)),
    "EmaState": ("frame", lambda array: prf.EmaState().update(array)),
    "DirectGoal": ("goal", lambda array: prf.DirectGoal(array).goal),
    "WindowGoal": ("goal", lambda array: prf.WindowGoal(array).goal),
    "MotionGoal": ("goal", lambda array: prf.MotionGoal(array).goal),
    "reset": ("frame", lambda array: prf.DirectGoal(IMAGE).reset(array)),
    "score": ("frame", lambda array: prf.DirectGoal(IMAGE).score(array)),
    "explain": ("frame", lambda array: prf.DirectGoal(IMAGE).explain(array)),
}
ANY = {**BYTES, "hog": ("image", prf.hog)}
takers = pytest.mark.parametrize("taker", BYTES)
all_takers = pytest.mark.parametrize("taker", ANY)


@all_takers
@pytest.mark.parametrize("form", FORMS)
def test_an_array_may_be_of_any_form(form: str, taker: str) -> None:
    _, call = ANY[taker]
    np.testing.assert_array_equal(call(FORMS[form](IMAGE)), call(IMAGE))


@all_takers
def test_only_arrays_with_gaps_are_copied_and_once(taker: str, monkeypatch: pytest.MonkeyPatch) -> None:
    copies: list[object] = []
    array = np.array

    def counted(*arguments: Any, **options: Any) -> Any:
        copies.append(arguments)
        return array(*arguments, **options)

    _, call = ANY[taker]
    gaps = spaced(IMAGE)
    monkeypatch.setattr(np, "array", counted)
    call(IMAGE)
    assert len(copies) == 0
    call(gaps)
    assert len(copies) == 1


class Subclass(NDArray[np.uint8] if TYPE_CHECKING else np.ndarray):  # type: ignore[misc]
    """An array that is one more thing."""


@all_takers
def test_arrays_of_subclasses_work_unless_they_are_masked(taker: str, tmp_path: Path) -> None:
    name, call = ANY[taker]
    mapped = np.memmap(tmp_path / "image", np.uint8, "w+", shape=IMAGE.shape)
    mapped[:] = IMAGE
    for array in (mapped, IMAGE.view(Subclass)):
        np.testing.assert_array_equal(call(array), call(IMAGE))
    for masked in (numpy_ma.masked_less(IMAGE, 9), numpy_ma.array(IMAGE)):
        refuse(lambda: call(masked), TypeError, f"{name}: got a masked array, expected a plain one")


def test_one_value_for_all_pixels_is_a_picture() -> None:
    flat = np.broadcast_to(np.uint8(7), (20, 30))
    np.testing.assert_array_equal(prf.hog(flat), np.zeros(20 * 30 * 9, np.float32))


@pytest.mark.parametrize(
    "dtype",
    ["bool", "int8", "int64", "uint16", "float16", "complex64", ">f4", "O", "U3", "M8[s]", [("x", "u1")]],
)
def test_other_dtypes_are_refused(dtype: Any) -> None:
    image: Any = np.zeros((9, 9), dtype)
    refuse(
        lambda: prf.hog(image),
        TypeError,
        f"image: got an array of {image.dtype}",
        "uint8, float32 or float64",
    )
    for name, call in BYTES.values():
        refuse(lambda: call(image), TypeError, f"{name}: got an array of {image.dtype}", "expected uint8")


@takers
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_floats_are_told_what_to_do(dtype: type[np.generic], taker: str) -> None:
    name, call = BYTES[taker]
    refuse(
        lambda: call(IMAGE.astype(dtype)),
        TypeError,
        f"{name}: got an array of float",
        ".round().astype(np.uint8)",
    )


@all_takers
@pytest.mark.parametrize("image", [3, [[1, 2], [3, 4]], memoryview(b"1234"), np.uint8(4), object()])
def test_what_is_no_array_is_refused(image: Any, taker: str) -> None:
    name, call = ANY[taker]
    refuse(lambda: call(image), TypeError, f"{name}: got {type(image).__name__}, expected a NumPy array")


@all_takers
@pytest.mark.parametrize(
    "shape", [(), (9,), (0, 0), (0, 9), (9, 0), (1, 1, 9, 9), (9, 9, 9, 3), (16385, 1), (1, 16385)]
)
def test_other_shapes_are_refused(shape: tuple[int, ...], taker: str) -> None:
    name, call = ANY[taker]
    got = f"got shape ({', '.join(map(str, shape))})"
    expected = "expected (height, width) with sides of 1 to 16384"
    refuse(lambda: call(np.zeros(shape, np.uint8)), ValueError, f"{name}: {got}", expected)


@pytest.mark.parametrize("taker", sorted(ANY.keys() - {"MotionGoal"}))
@pytest.mark.parametrize("shape", [(9, 9, 3), (9, 9, 4)])
def test_colours_are_told_what_to_do(shape: tuple[int, ...], taker: str) -> None:
    refuse(lambda: ANY[taker][1](np.zeros(shape, np.uint8)), ValueError, "turn colours to grey first")


@all_takers
def test_an_axis_of_one_value_is_told_what_to_do(taker: str) -> None:
    if taker != "MotionGoal":
        refuse(lambda: ANY[taker][1](IMAGE[..., np.newaxis]), ValueError, "got shape (24, 36, 1)", "give array[..., 0]")


@all_takers
def test_a_picture_that_takes_no_memory_itself_is_refused_when_huge(taker: str) -> None:
    huge = np.broadcast_to(np.uint8(9), (1 << 30, 1 << 20))
    refuse(lambda: ANY[taker][1](huge), ValueError, "got shape (1073741824, 1048576)")


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
