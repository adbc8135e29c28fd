"""Pictures for the tests, the same every time."""

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]


def natural(height: int, width: int, seed: int = 1) -> Bytes:
    """Noise whose amplitude falls with the frequency, as it does in photographs."""
    rng = np.random.default_rng(seed)
    spectrum = np.fft.fft2(rng.standard_normal((height, width)))
    rows, columns = np.fft.fftfreq(height)[:, None], np.fft.fftfreq(width)[None, :]
    spectrum /= np.maximum(np.hypot(rows, columns), 1 / max(height, width))
    noise = np.fft.ifft2(spectrum).real
    low, high = noise.min(), noise.max()
    picture: Bytes = np.round(1 + 254 * (noise - low) / (high - low)).astype(np.uint8)
    return picture


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
    picture: Bytes = np.round(63 * (waves + 2)).astype(np.uint8)
    return picture


PICTURES = {
    "natural": natural(60, 83),
    "boxes": boxes(64, 47),
    "stripes": stripes(51, 50),
    "black": np.zeros((40, 44), np.uint8),
}
