"""Rewards from pictures: how much a frame looks like a picture of the finished task.

>>> import numpy as np
>>> import prf
>>> goal = np.zeros((84, 84), np.uint8)
>>> prf.reward(goal, goal)
1.0

Pictures are two-dimensional arrays of grey values. Functions let other threads run while they compute,
so a picture must not be written to meanwhile.
"""

from prf._native import __version__, distance, hog, reward

__all__ = ["__version__", "distance", "hog", "reward"]
