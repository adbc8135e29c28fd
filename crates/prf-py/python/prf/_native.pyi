from collections.abc import Sequence
from os import PathLike
from typing import Any, Literal, TypeAlias, final

import numpy as np
from numpy.typing import NDArray
from typing_extensions import Self, disjoint_base

from prf._results import Score

_Norm: TypeAlias = Literal["none", "l1", "l1-sqrt", "l2", "l2-hys"]
_Scale: TypeAlias = Literal["none", "sqrt-blocks", "sqrt-features"]
_Method: TypeAlias = Literal["ccorr-normed", "ccoeff-normed"]
_Picture: TypeAlias = NDArray[np.uint8]
_PictureOrPath: TypeAlias = NDArray[np.uint8] | str | PathLike[str]

__all__ = [
    "DirectGoal",
    "Goal",
    "MotionGoal",
    "Tasks",
    "WindowGoal",
    "__version__",
    "distance",
    "hog",
    "preset_goal",
    "preset_limit_steps",
    "reward",
]

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
    goal: _Picture,
    frame: _Picture,
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
    goal: _Picture,
    frame: _Picture,
    *,
    orientations: int = 9,
    signed: bool = False,
    cell: float | None = None,
    cell_px: int | None = None,
    block_cells: int = 1,
    norm: _Norm = "l2",
    scale: _Scale = "sqrt-blocks",
) -> float: ...

@disjoint_base
class Goal:
    @property
    def goal(self) -> _Picture: ...
    @property
    def orientations(self) -> int: ...
    @property
    def signed(self) -> bool: ...
    @property
    def cell(self) -> float | None: ...
    @property
    def cell_px(self) -> int | None: ...
    @property
    def block_cells(self) -> int: ...
    @property
    def norm(self) -> _Norm: ...
    @property
    def scale(self) -> _Scale: ...
    def reset(self, frame: _Picture | None = None) -> None: ...
    def reward(self, frame: _Picture) -> float: ...
    def score(self, frame: _Picture) -> Score: ...
    def rewards(self, frames: _Picture, *, threads: int | None = None) -> NDArray[np.float32]: ...
    def explain(self, frame: _Picture) -> _Picture: ...
    def copy(self) -> Self: ...
    def __getnewargs_ex__(self) -> tuple[tuple[_Picture], dict[str, Any]]: ...
    def __getstate__(self) -> bytes | None: ...
    def __setstate__(self, state: bytes) -> None: ...

@final
class DirectGoal(Goal):
    def __new__(
        cls,
        goal: _PictureOrPath,
        *,
        orientations: int = 9,
        signed: bool = False,
        cell: float | None = None,
        cell_px: int | None = None,
        block_cells: int = 1,
        norm: _Norm = "l2",
        scale: _Scale = "sqrt-blocks",
    ) -> Self: ...

@final
class WindowGoal(Goal):
    def __new__(
        cls,
        goal: _PictureOrPath,
        *,
        mask: _PictureOrPath | NDArray[np.bool_] | None = None,
        method: _Method = "ccorr-normed",
        orientations: int = 9,
        signed: bool = False,
        cell: float | None = None,
        cell_px: int | None = None,
        block_cells: int = 1,
        norm: _Norm = "l2",
        scale: _Scale = "sqrt-blocks",
    ) -> Self: ...
    @property
    def mask(self) -> _Picture | None: ...
    @property
    def method(self) -> _Method: ...

@final
class MotionGoal(Goal):
    def __new__(
        cls,
        goal: _PictureOrPath,
        *,
        threshold: int = 30,
        tau_start: float = 0.1,
        tau_step: float = 0.4,
        delta_divisor: float | None = None,
        duration: float | None = None,
        skip_still: bool = False,
        orientations: int = 9,
        signed: bool = False,
        cell: float | None = None,
        cell_px: int | None = None,
        block_cells: int = 1,
        norm: _Norm = "l2",
        scale: _Scale = "sqrt-blocks",
    ) -> Self: ...
    @property
    def threshold(self) -> int: ...
    @property
    def tau_start(self) -> float: ...
    @property
    def tau_step(self) -> float: ...
    @property
    def delta_divisor(self) -> float | None: ...
    @property
    def duration(self) -> float | None: ...
    @property
    def skip_still(self) -> bool: ...

def preset_goal(name: str, goal: _PictureOrPath | None = None) -> DirectGoal | WindowGoal | MotionGoal: ...
def preset_limit_steps(name: str) -> int: ...
@final
class Tasks:
    def __new__(
        cls,
        preset: str,
        *,
        num_envs: int = 1,
        goal: Goal | None = None,
        state: str | None = None,
        max_episode_steps: int | None = None,
        threads: int | None = None,
    ) -> Self: ...
    @property
    def actions(self) -> Sequence[str]: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    def reset(
        self, mask: NDArray[np.bool_], seeds: NDArray[np.uint64], observations: NDArray[np.uint8]
    ) -> None: ...
    def step(
        self,
        actions: NDArray[np.int64],
        restart: NDArray[np.bool_] | None,
        seeds: NDArray[np.uint64],
        observations: NDArray[np.uint8],
        rewards: NDArray[np.float64],
        scores: NDArray[np.float64],
        terminated: NDArray[np.bool_],
        truncated: NDArray[np.bool_],
    ) -> int: ...
    def render(self, frames: NDArray[np.uint8]) -> None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, Any]]: ...
    def __getstate__(self) -> bytes: ...
    def __setstate__(self, state: bytes) -> None: ...
