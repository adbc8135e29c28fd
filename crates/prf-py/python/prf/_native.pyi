from collections.abc import Sequence
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

_Norm: TypeAlias = Literal["none", "l1", "l1-sqrt", "l2", "l2-hys"]
_Scale: TypeAlias = Literal["none", "sqrt-blocks", "sqrt-features"]

__all__ = ["__version__", "distance", "hog", "main", "reward"]

__version__: str

def hog(
    image: NDArray[np.uint8] | NDArray[np.float32] | NDArray[np.float64],
    *,
    orientations: int = 9,
    signed: bool = False,
    cell: float | None = None,
    cell_px: int | None = None,
    block_cells: int = 1,
    norm: _Norm = "l2",
    feature_vector: bool = True,
) -> NDArray[np.float32]: ...
def reward(
    goal: NDArray[np.uint8],
    frame: NDArray[np.uint8],
    *,
    orientations: int = 9,
    signed: bool = False,
    cell: float | None = None,
    cell_px: int | None = None,
    block_cells: int = 1,
    norm: _Norm = "l2",
    scale: _Scale = "sqrt-blocks",
) -> float: ...
def distance(
    goal: NDArray[np.uint8],
    frame: NDArray[np.uint8],
    *,
    orientations: int = 9,
    signed: bool = False,
    cell: float | None = None,
    cell_px: int | None = None,
    block_cells: int = 1,
    norm: _Norm = "l2",
    scale: _Scale = "sqrt-blocks",
) -> float: ...
def main(args: Sequence[str]) -> int: ...
