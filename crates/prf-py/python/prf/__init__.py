"""Rewards from pictures: how much a frame looks like a picture of the finished task.

>>> import numpy as np
>>> import prf
>>> goal = prf.DirectGoal(np.zeros((84, 84), np.uint8))
>>> goal.reward(np.zeros((84, 84), np.uint8))
1.0

Pictures are two-dimensional arrays of grey values. Functions let other threads run while they compute,
so a picture must not be written to meanwhile.
"""

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
    reward,
    reward_batch,
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
    "reward",
    "reward_batch",
]
