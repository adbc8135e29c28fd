"""Rewards from pictures: how much a frame looks like a picture of the finished task.

>>> import numpy as np
>>> import prf
>>> goal = prf.DirectGoal(np.zeros((84, 84), np.uint8))
>>> goal.reward(np.zeros((84, 84), np.uint8))
1.0

Pictures are two-dimensional arrays of grey values. Functions let other threads run while they compute,
so a picture must not be written to meanwhile.
"""

from prf._native import DirectGoal, Goal, MotionGoal, WindowGoal, __version__, distance, hog, reward
from prf._results import Match, Rect, Score

__all__ = [
    "DirectGoal",
    "Goal",
    "Match",
    "MotionGoal",
    "Rect",
    "Score",
    "WindowGoal",
    "__version__",
    "distance",
    "hog",
    "reward",
]
