"""The worlds of PRF as Gymnasium environments, one by one and many at once.

``import prf`` registers them, so that ``gymnasium.make("PRF/Breakout-v0")`` and ``gymnasium.make_vec`` find them:
``PRF/Breakout-v0``, ``PRF/FlappyBird-v0`` and ``PRF/KobianFace-v0``. Their keyword arguments are those of the classes
here.
"""

from prf._extras import require_gymnasium

require_gymnasium("prf.envs")

from prf.envs.single import BreakoutEnv, FlappyBirdEnv, KobianFaceEnv, WorldEnv
from prf.envs.vector import (
    BreakoutVectorEnv,
    FlappyBirdVectorEnv,
    KobianFaceVectorEnv,
    WorldVectorEnv,
)

__all__ = [
    "BreakoutEnv",
    "BreakoutVectorEnv",
    "FlappyBirdEnv",
    "FlappyBirdVectorEnv",
    "KobianFaceEnv",
    "KobianFaceVectorEnv",
    "WorldEnv",
    "WorldVectorEnv",
]
