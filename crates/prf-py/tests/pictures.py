"""Pictures for the tests, the same every time."""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageSequence

Bytes = NDArray[np.uint8]


def to_bytes(values: NDArray[np.float64]) -> Bytes:
    rounded: NDArray[np.float64] = np.rint(values)
    return rounded.astype(np.uint8)


def natural(height: int, width: int, seed: int = 1) -> Bytes:
    """Noise whose amplitude falls with the frequency, as it does in photographs."""
    rng = np.random.default_rng(seed)
    spectrum = np.fft.fft2(rng.standard_normal((height, width)))
    rows, columns = np.fft.fftfreq(height)[:, None], np.fft.fftfreq(width)[None, :]
    spectrum /= np.maximum(np.hypot(rows, columns), 1 / max(height, width))
    noise = np.fft.ifft2(spectrum).real
    low, high = noise.min(), noise.max()
    return to_bytes(1 + 254 * (noise - low) / (high - low))


def boxes(height: int, width: int) -> Bytes:
    """Bright boxes on black: large flat areas and straight edges, as worlds draw them."""
    picture = np.zeros((height, width), np.uint8)
    picture[height // 8 : height // 2, width // 5 : width // 3] = 255
    picture[height // 3 : -3, width // 2 : -5] = 128
    picture[-5:-2, 1 : width // 4] = 61
    return picture


def stripes(height: int, width: int) -> Bytes:
    """Slanted waves, so that every direction's neighbours are seen."""
    y, x = np.mgrid[:height, :width]
    waves = np.sin(x / 3 + y / 5) + np.sin(x * y / 90)
    return to_bytes(63 * (waves + 2))


PICTURES = {
    "natural": natural(60, 83),
    "boxes": boxes(64, 47),
    "stripes": stripes(51, 50),
    "black": np.zeros((40, 44), np.uint8),
}


def moving(count: int, height: int, width: int) -> Bytes:
    """A bar that grows and a box that wanders, before noise that stays below a threshold of 30."""
    rng = np.random.default_rng(count)
    frames: Bytes = rng.integers(0, 15, (count, height, width), np.uint8)
    for t in range(count):
        frames[t, 2 : 6 + t, width // 3 : width // 2] = 200
        left = 3 * t % (width - 6)
        frames[t, -9:-3, left : left + 6] = 255
    return frames


def read(path: Path) -> Bytes:
    """A grey picture in a file."""
    picture: Bytes = read_frames(path)[0]
    return picture


def read_frames(path: Path) -> Bytes:
    """The frames of a grey animation."""
    with Image.open(path) as image:
        frames = [np.asarray(frame.convert("L"), np.uint8) for frame in ImageSequence.Iterator(image)]
    stack: Bytes = np.stack(frames)
    return stack
