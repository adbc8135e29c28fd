"""What environments can be told."""

import operator
from os import PathLike
from typing import Literal, TypeAlias, TypedDict

import numpy as np
from numpy.typing import NDArray

from prf._native import Goal, Tasks, preset_goal

World: TypeAlias = Literal["breakout", "flappy", "kobian-happy", "kobian-surprise"]
Expression: TypeAlias = Literal["happy", "surprise"]
Reward: TypeAlias = Literal["perceptual", "variable"]
State: TypeAlias = Literal["mirror", "ema", "motion"]
GoalLike: TypeAlias = Goal | NDArray[np.uint8] | str | PathLike[str]
Size: TypeAlias = int | tuple[int, int]

MAX_RENDER_SIDE = 4096

PERCEPTUAL_PRESETS = {
    "breakout": "breakout",
    "flappy": "flappy",
    "kobian-happy": "kobian-happy-kprf",
    "kobian-surprise": "kobian-surprise-kprf",
}


class Options(TypedDict, total=False):
    """Keyword arguments of every environment; :class:`WorldEnv` explains them."""

    reward: Reward
    goal: GoalLike | None
    state: State | None
    max_episode_steps: int | None
    render_mode: str | None
    render_size: Size


def make_tasks(
    world: World,
    num_envs: int,
    reward: Reward,
    goal: GoalLike | None,
    state: State | None,
    max_episode_steps: int | None,
    threads: int | None = None,
) -> Tasks:
    """The tasks behind an environment."""
    choice("world", world, tuple(PERCEPTUAL_PRESETS))
    choice("reward", reward, ("perceptual", "variable"))
    if reward == "perceptual":
        preset = PERCEPTUAL_PRESETS[world]
        if not isinstance(goal, Goal):
            goal = preset_goal(preset, goal)
    else:
        preset = f"{world}-vrf"
        if goal is not None:
            message = f"goal: got {type(goal).__name__}, expected None, because reward is 'variable'"
            raise ValueError(message)
    return Tasks(
        preset, num_envs=num_envs, goal=goal, state=state, max_episode_steps=max_episode_steps, threads=threads
    )


def choice(name: str, value: object, choices: tuple[str, ...]) -> None:
    """Refuses an argument that is none of some strings."""
    if value not in choices:
        raise ValueError(f"{name}: got {value!r}, expected one of {', '.join(map(repr, choices))}")


def read_size(name: str, size: Size) -> tuple[int, int]:
    """Height and width of a picture: a side of a square, or both."""
    expected = f"expected a side or (height, width) of 1 to {MAX_RENDER_SIDE} pixels"
    try:
        sides = tuple(map(operator.index, size)) if isinstance(size, tuple) else (operator.index(size),) * 2
    except TypeError:
        raise TypeError(f"{name}: got {size!r}, {expected}") from None
    if len(sides) != 2 or not all(1 <= side <= MAX_RENDER_SIDE for side in sides):
        raise ValueError(f"{name}: got {size!r}, {expected}")
    return sides[0], sides[1]
