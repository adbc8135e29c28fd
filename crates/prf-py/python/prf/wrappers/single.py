"""A reward from pictures for one environment."""

from typing import Any, TypeVar

import gymnasium as gym
import numpy as np
from gymnasium.utils import RecordConstructorArgs
from numpy.typing import NDArray

from prf.envs.options import GoalLike, Size
from prf.wrappers.frames import Frames, Source
from prf.wrappers.goals import Descriptor, make_goal

Obs = TypeVar("Obs")
Act = TypeVar("Act")


class PerceptualReward(gym.Wrapper[Obs, Act, Obs, Act], RecordConstructorArgs):
    """The reward of a step is how much the frame after it looks like the goal, above 0 and at most 1.

    ``info["original_reward"]`` is what the environment gave; where the environment has one in its ``info`` already, as
    with two of these wrappers, that stays.

    Parameters
    ----------
    env : gymnasium.Env
        Made with ``render_mode="rgb_array"``; or with pictures as observations.
    goal : DirectGoal, WindowGoal, MotionGoal, ndarray, str or os.PathLike
        What the finished task looks like. Of a goal the wrapper takes a copy; from an array or a file it makes one with
        default settings.
    descriptor : {"direct", "window", "motion"}, optional
        Of which kind a goal is that is made here; "direct" where it isn't given.
    source : {"render", "observation"}
        Where frames come from: ``env.render()`` or the observations.
    size : int or (int, int), optional
        Side, or height and width in pixels, to which frames are brought before they are compared.

    Raises
    ------
    TypeError, ValueError, OSError
        An argument has another type or doesn't fit the environment, or the goal can't be read. A frame is no picture,
        or smaller than the goal of a window goal: by ``reset`` and ``step``, if its size isn't known before.

    Examples
    --------
    >>> import gymnasium, prf
    >>> env = gymnasium.make("PRF/FlappyBird-v0", reward="variable", render_mode="rgb_array", render_size=84)
    >>> env = prf.wrappers.PerceptualReward(env, prf.preset_goal("flappy"))
    >>> _ = env.reset(seed=1)
    >>> _, reward, _, _, info = env.step(0)
    >>> 0 < reward <= 1, round(info["original_reward"], 1)
    (True, 0.1)
    """

    def __init__(
        self,
        env: gym.Env[Obs, Act],
        goal: GoalLike,
        *,
        descriptor: Descriptor | None = None,
        source: Source = "render",
        size: Size | None = None,
    ) -> None:
        RecordConstructorArgs.__init__(self, goal=goal, descriptor=descriptor, source=source, size=size)
        gym.Wrapper.__init__(self, env)
        self._frames = Frames(source, size, env.render_mode, env.observation_space)
        self.goal = make_goal(goal, descriptor)
        """The goal, with the episode so far."""
        self._frames.check_goal(self.goal)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Obs, dict[str, Any]]:
        """Begins an episode of the environment and of the goal."""
        observation, info = self.env.reset(seed=seed, options=options)
        self.goal.reset(self._frame(observation))
        return observation, info

    def step(self, action: Act) -> tuple[Obs, float, bool, bool, dict[str, Any]]:
        """Plays a step and rewards the frame after it."""
        observation, original, terminated, truncated, info = self.env.step(action)
        reward = self.goal.reward(self._frame(observation))
        return observation, reward, terminated, truncated, {"original_reward": original, **info}

    def _frame(self, observation: Obs) -> NDArray[np.uint8]:
        return self._frames.grey(self.env.render() if self._frames.are_rendered else observation)
