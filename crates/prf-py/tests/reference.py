"""What HOG and distance are by their definitions, in plain NumPy."""

from typing import Any

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


def motion_history(
    frames: NDArray[np.uint8],
    threshold: int = 30,
    tau_start: float = 0.1,
    tau_step: float = 0.4,
    delta_divisor: float = 3,
    duration: float | None = None,
    skip_still: bool = False,
) -> tuple[Floats, float]:
    """When each pixel moved last, and the time of the last frame that counts."""
    history, tau, t, before = np.zeros(frames.shape[1:]), 0.0, 0, frames[:1]
    for frame in frames[1:]:
        moved = np.abs(frame.astype(int) - before[0]) > threshold
        if skip_still and not moved.any():
            continue
        tau = tau_start + tau_step * t
        delta = (t + 1) / delta_divisor if duration is None else duration
        history[(history < np.float32(tau - delta)) & ~moved] = 0
        history[moved] = np.float32(tau)
        t, before = t + 1, frame[None]
    return history, tau


def motion_template(frames: NDArray[np.uint8], **options: Any) -> NDArray[np.uint8]:
    history, tau = motion_history(frames, **options)
    scaled: NDArray[np.uint8] = np.floor(255 * history / (tau or 1) + 0.5).astype(np.uint8)
    return scaled
