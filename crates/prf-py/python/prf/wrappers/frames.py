"""Where a wrapper takes frames from."""

from typing import Any, Literal, TypeAlias

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from prf._native import Goal, WindowGoal, to_grey
from prf.envs.options import Size, choice, read_size

Source: TypeAlias = Literal["render", "observation"]

SHAPES = "(height, width), (height, width, 1), (height, width, 3) or (height, width, 4)"


class Frames:
    """Turns what an environment renders or lets see into grey frames of one size."""

    def __init__(
        self, source: Source, size: Size | None, render_mode: str | None, observation_space: Any
    ) -> None:
        choice("source", source, ("render", "observation"))
        self.are_rendered = source == "render"
        """Whether frames are what ``render()`` gives rather than observations."""
        self._size = None if size is None else read_size("size", size)
        if self.are_rendered and render_mode != "rgb_array":
            raise ValueError(
                f"env: got render_mode={render_mode!r}, expected 'rgb_array'; or take source='observation'"
            )
        self._shape: tuple[int, int] | None = self._size
        """Height and width of the frames that are compared, where they are known."""
        if not self.are_rendered:
            check_observation_space(observation_space)
            self._shape = self._size or observation_space.shape[:2]

    def check_goal(self, goal: Goal) -> None:
        """Refuses a window that has no place in the frames, where their size is known."""
        if self._shape is None or not isinstance(goal, WindowGoal):
            return
        (height, width), (frame_height, frame_width) = goal.goal.shape, self._shape
        if height > frame_height or width > frame_width:
            frames = f"frames of {frame_width}x{frame_height} px"
            raise ValueError(f"goal: got a window of {width}x{height} px, expected one that fits into {frames}")

    def grey(self, frame: Any) -> NDArray[np.uint8]:
        """The frame in grey."""
        if not is_array(frame):
            what = "render()" if self.are_rendered else "observation"
            raise TypeError(f"{what}: got {type(frame).__name__}, expected an array of shape {SHAPES}")
        return to_grey(frame, size=self._size)


def is_array(value: object) -> bool:
    """Whether it is an array of any type."""
    return isinstance(value, np.ndarray)


def check_observation_space(space: Any) -> None:
    """Refuses observations that are no pictures."""
    is_box = space.dtype == np.uint8 and isinstance(space, spaces.Box)
    shape: tuple[int, ...] = space.shape or ()
    if not is_box or len(shape) not in (2, 3) or (len(shape) == 3 and shape[2] not in (1, 3, 4)):
        raise ValueError(f"env: got observations of {space}, expected a Box of uint8 with shape {SHAPES}")
