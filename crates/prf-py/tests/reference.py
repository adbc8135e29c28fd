"""What HOG and distance are by their definitions, in plain NumPy."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


def hog(image: NDArray[np.uint8], cell: int, bins: int = 9, signed: bool = False) -> Floats:
    """L2-normalised histograms of `(rows, columns, bins)`; a block is a cell."""
    pixels = image.astype(np.float64)
    dy, dx = np.zeros_like(pixels), np.zeros_like(pixels)
    dy[1:-1] = pixels[2:] - pixels[:-2]
    dx[:, 1:-1] = pixels[:, 2:] - pixels[:, :-2]
    span = 360 if signed else 180
    chosen = (np.degrees(np.arctan2(dy, dx)) % span // (span / bins)).astype(int) % bins
    votes = np.hypot(dx, dy)[..., None] * (chosen[..., None] == np.arange(bins)) / 255
    rows, columns = (side // cell for side in image.shape)
    whole = votes[: rows * cell, : columns * cell]
    cells: Floats = whole.reshape(rows, cell, columns, cell, bins).mean(axis=(1, 3))
    normalised: Floats = cells / np.sqrt((cells**2).sum(axis=2, keepdims=True) + 1e-10)
    return normalised


def distance(goal: Floats, frame: Floats, divisor: float = 1) -> float:
    return float(np.linalg.norm(goal - frame)) / divisor
