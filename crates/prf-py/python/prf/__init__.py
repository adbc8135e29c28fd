"""Rewards from pictures: how much a frame looks like a picture of the finished task.

>>> import numpy as np
>>> import prf
>>> goal = prf.DirectGoal(np.zeros((84, 84), np.uint8))
>>> goal.reward(np.zeros((84, 84), np.uint8))
1.0

Pictures are two-dimensional arrays of grey values. Functions let other threads run while they compute,
so a picture must not be written to meanwhile.

Where Gymnasium is installed, ``PRF/Breakout-v0``, ``PRF/FlappyBird-v0`` and ``PRF/KobianFace-v0`` are registered: see
``prf.envs``. ``prf.wrappers`` gives other environments a reward from pictures.
"""

from importlib import import_module
from typing import TYPE_CHECKING

from prf._extras import has_gymnasium
from prf._native import (
    DirectGoal,
    EmaState,
    Goal,
    MotionGoal,
    MotionTemplate,
    WindowGoal,
    __version__,
    crop,
    crop_box,
    crop_box_batch,
    distance,
    distance_batch,
    hog,
    hog_batch,
    match_template,
    match_template_batch,
    motion_template,
    preset_goal,
    reward,
    reward_batch,
    to_grey,
)
from prf._results import Match, Rect, Score

__all__ = [
    "DirectGoal",
    "EmaState",
    "Goal",
    "Match",
    "MotionGoal",
    "MotionTemplate",
    "Rect",
    "Score",
    "WindowGoal",
    "__version__",
    "crop",
    "crop_box",
    "crop_box_batch",
    "distance",
    "distance_batch",
    "hog",
    "hog_batch",
    "match_template",
    "match_template_batch",
    "motion_template",
    "preset_goal",
    "reward",
    "reward_batch",
    "to_grey",
]

if has_gymnasium():
    from prf._registration import register_envs

    register_envs()

if TYPE_CHECKING:
    from prf import envs as envs
    from prf import wrappers as wrappers
else:

    def __getattr__(name: str) -> object:
        """Imports what needs Gymnasium when it is asked for."""
        if name in ("envs", "wrappers"):
            return import_module(f"{__name__}.{name}")
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
