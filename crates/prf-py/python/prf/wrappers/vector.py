"""A reward from pictures for a vector environment."""

from typing import Any

import numpy as np
from gymnasium.logger import warn
from gymnasium.vector import AutoresetMode, VectorEnv, VectorWrapper
from numpy.typing import NDArray

from prf.envs.options import GoalLike, Size
from prf.envs.vector import read_mode
from prf.wrappers.frames import Frames, Source
from prf.wrappers.goals import Descriptor, make_goal

KEY = "original_reward"


class PerceptualReward(VectorWrapper):
    """The reward of each environment's step is how much its frame after it looks like the goal, above 0 and at most 1.

    ``infos["original_reward"]`` is what the environments gave, unless they have one in their infos already. A step in
    which an episode begins has the reward 0, as always in Gymnasium. With the autoreset mode ``SAME_STEP`` an episode's last frame can't be rendered any more,
    so frames have to be observations.

    Parameters
    ----------
    env : gymnasium.vector.VectorEnv
        Made with ``render_mode="rgb_array"``; or with pictures as observations.
    goal, descriptor, source, size
        As for :class:`prf.wrappers.PerceptualReward`. Each environment has a copy of the goal.

    Raises
    ------
    TypeError, ValueError, OSError
        As for :class:`prf.wrappers.PerceptualReward`.
    """

    def __init__(
        self,
        env: VectorEnv[Any, Any, Any],
        goal: GoalLike,
        *,
        descriptor: Descriptor | None = None,
        source: Source = "render",
        size: Size | None = None,
    ) -> None:
        super().__init__(env)
        self._frames = Frames(source, size, env.render_mode, getattr(env, "single_observation_space"))
        self._mode = autoreset_mode(env)
        if self._mode is AutoresetMode.SAME_STEP and self._frames.are_rendered:
            raise ValueError(
                "source: got 'render' with the autoreset mode SAME_STEP, in which the last frame of an episode can't be "
                "rendered; expected 'observation', or another mode"
            )
        first = make_goal(goal, descriptor)
        self._frames.check_goal(first)
        self.goals = (first, *(first.copy() for _ in range(env.num_envs - 1)))
        """The goals of the environments, each with the episode so far."""
        # Where the step to come begins an episode and plays nothing.
        self._restarts = np.zeros(env.num_envs, np.bool_)

    def reset(
        self, *, seed: Any = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins episodes of the environments and of their goals; or only those of ``options["reset_mask"]``."""
        # Some environments take the mask out of the options.
        mask = (options or {}).get("reset_mask", np.ones(self.num_envs, np.bool_))
        observations, infos = self.env.reset(seed=seed, options=options)
        self._restarts = self._restarts & ~mask
        for goal, begins, frame in zip(self.goals, mask, self._look(observations), strict=True):
            if begins:
                goal.reset(frame)
        return observations, infos

    def step(
        self, actions: Any
    ) -> tuple[Any, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Plays a step in each environment and rewards the frames after it."""
        observations, originals, terminated, truncated, infos = self.env.step(actions)
        over = terminated | truncated
        # Where an episode is over and the next one has begun in this very step.
        replaced = over if self._mode is AutoresetMode.SAME_STEP else np.zeros_like(over)
        rewards = np.zeros(self.num_envs)
        for index, (goal, frame) in enumerate(zip(self.goals, self._look(observations), strict=True)):
            if self._restarts[index]:
                goal.reset(frame)
            elif replaced[index]:
                rewards[index] = goal.reward(self._frames.grey(infos["final_obs"][index]))
                goal.reset(frame)
            else:
                rewards[index] = goal.reward(frame)
        infos = {**info_of(originals, ~(self._restarts | replaced)), **infos}
        if replaced.any():
            final = {**info_of(originals, replaced), **infos.get("final_info", {})}
            infos.update(final_info=final, _final_info=replaced.copy())
        self._restarts = over if self._mode is AutoresetMode.NEXT_STEP else np.zeros_like(over)
        return observations, rewards, terminated, truncated, infos

    def _look(self, observations: Any) -> list[NDArray[np.uint8]]:
        pictures: Any = self.env.render() if self._frames.are_rendered else observations
        try:
            frames: list[Any] = list(pictures)
        except TypeError:
            raise TypeError(f"render(): got {type(pictures).__name__}, expected {self.num_envs} frames") from None
        if len(frames) != self.num_envs:
            raise ValueError(f"render(): got {len(frames)} frames, expected {self.num_envs}")
        return [self._frames.grey(frame) for frame in frames]


def autoreset_mode(env: VectorEnv[Any, Any, Any]) -> AutoresetMode:
    """When the environments' next episodes begin."""
    mode = env.metadata.get("autoreset_mode")
    if mode is None:
        warn(f"{env} doesn't say when episodes begin: metadata['autoreset_mode'] is missing, NEXT_STEP is assumed")
        return AutoresetMode.NEXT_STEP
    return read_mode(mode)


def info_of(originals: NDArray[Any], mask: NDArray[np.bool_]) -> dict[str, Any]:
    """The original rewards where there are any, as Gymnasium joins the ``info`` of environments."""
    return {KEY: np.where(mask, originals, 0), f"_{KEY}": mask} if mask.any() else {}
