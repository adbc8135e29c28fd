"""Environments one by one."""

import operator
from typing import Any, TypeAlias

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.error import ClosedEnvironmentError, InvalidAction, ResetNeeded
from numpy.typing import NDArray
from typing_extensions import Unpack

from prf.envs.options import Expression, GoalLike, Options, Reward, Size, State, World, choice, make_tasks, read_size
from prf.envs.rendering import Window
from prf.envs.seeds import draw_seed, episode_of

Observation: TypeAlias = NDArray[np.uint8]
Action: TypeAlias = int | np.integer[Any]


class WorldEnv(gym.Env[Observation, Action]):
    """A world of PRF with a reward: what the environments of one world have in common.

    Observations are ``(84, 84)`` arrays of ``uint8``, actions are numbers from 0 on. After each step ``info`` has
    the world's ``score`` so far in the episode, whatever the reward is.

    The episode of ``reset(seed=n)`` is the world's episode ``n``, the same as on the command line. Without a seed,
    ``np_random`` draws one.

    Parameters
    ----------
    world : {"breakout", "flappy", "kobian-happy", "kobian-surprise"}
        The environments of one world have no such parameter.
    reward : {"perceptual", "variable"}
        How much the frame after the action looks like the goal, above 0 and at most 1; or the world's own.
    goal : DirectGoal, WindowGoal, MotionGoal, ndarray, str or os.PathLike, optional
        What the finished task looks like; an array or a file takes the place of the preset's goal and keeps its
        settings. Without it, it is ``prf.preset_goal`` of "breakout", "flappy", "kobian-happy-kprf" or
        "kobian-surprise-kprf". Its size is that of the worlds, 84 x 84 pixels, or less for a part.
    state : {"mirror", "ema", "motion"}, optional
        What the agent sees: the frame; the moving average of the episode's frames; or where something moved in
        the episode, the newest brightest (with the schedule of the goal if that is a ``MotionGoal``). Without
        it, it is "ema" for Breakout and Flappy Bird, for the face "motion" with a perceptual and "mirror" with
        the variable reward.
    max_episode_steps : int, at least 1, optional
        Steps after which an episode is truncated. ``gymnasium.make`` truncates by itself, after as many as are
        registered.
    render_mode : {"rgb_array", "human"}, optional
    render_size : int or (int, int), 1 to 4096
        Side, or height and width, of rendered frames in pixels. Worlds are drawn anew at each size.

    Raises
    ------
    TypeError, ValueError, OSError
        An argument has another type or is out of range, or a goal can't be read.
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 15}

    def __init__(
        self,
        world: World,
        *,
        reward: Reward = "perceptual",
        goal: GoalLike | None = None,
        state: State | None = None,
        max_episode_steps: int | None = None,
        render_mode: str | None = None,
        render_size: Size = 336,
    ) -> None:
        if render_mode is not None:
            choice("render_mode", render_mode, ("human", "rgb_array"))
        self.render_mode = render_mode
        self.render_size = read_size("render_size", render_size)
        """Height and width of rendered frames."""
        self._tasks = make_tasks(world, 1, reward, goal, state, max_episode_steps)
        self.observation_space = spaces.Box(0, 255, self._tasks.shape, np.uint8)
        self._actions = len(self._tasks.actions)
        self.action_space = spaces.Discrete(self._actions)
        self._has_begun = False
        self._is_closed = False
        self._window: Window | None = None
        # What a step writes to, besides the observation.
        self._action = np.zeros(1, np.int64)
        self._seed = np.zeros(1, np.uint64)
        self._numbers = np.zeros((2, 1))
        self._flags = np.zeros((2, 1), np.bool_)

    @property
    def action_names(self) -> tuple[str, ...]:
        """What the actions are called, in their order."""
        return tuple(self._tasks.actions)

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begins an episode; there are no options."""
        self._check_open()
        super().reset(seed=seed)
        self._seed[0] = draw_seed(self.np_random) if seed is None else episode_of(seed)
        observation = np.empty(self._tasks.shape, np.uint8)
        self._tasks.reset(np.ones(1, np.bool_), self._seed, observation[np.newaxis])
        self._has_begun = True
        self._show()
        return observation, {}

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Plays a step.

        Raises
        ------
        TypeError
            The action is no integer.
        gymnasium.error.InvalidAction
            It is out of range.
        gymnasium.error.ResetNeeded
            No episode has begun, or it is over.
        gymnasium.error.ClosedEnvironmentError
            The environment is closed.
        """
        self._check_open()
        self._action[0] = self._read(action)
        observation = np.empty(self._tasks.shape, np.uint8)
        (rewards, scores), (terminated, truncated) = self._numbers, self._flags
        batch = observation[np.newaxis]
        self._tasks.step(self._action, None, self._seed, batch, rewards, scores, terminated, truncated)
        self._show()
        return observation, rewards.item(), terminated.item(), truncated.item(), {"score": scores.item()}

    def render(self) -> NDArray[np.uint8] | None:
        """A frame of shape ``(height, width, 3)``; or None where a window shows it or there is no render mode."""
        if self.render_mode is None:
            gym.logger.warn("render() without a render mode: make the environment with render_mode='rgb_array'")
            return None
        self._check_open()
        if not self._has_begun:
            raise ResetNeeded("render: got no episode yet, expected a reset before it")
        if self.render_mode == "human":
            self._show()
            return None
        return self._draw()

    def close(self) -> None:
        """Closes the window, if there is one."""
        self._is_closed = True
        if self._window is not None:
            self._window.close()
            self._window = None

    def _read(self, action: Action) -> int:
        try:
            index = operator.index(action)
        except TypeError:
            got = f"{type(action).__name__} {action!r}"
            raise TypeError(f"action: got {got}, expected an integer") from None
        if not 0 <= index < self._actions:
            raise InvalidAction(f"action: got {index}, expected 0 to {self._actions - 1}")
        return index

    def _check_open(self) -> None:
        if self._is_closed:
            raise ClosedEnvironmentError("this environment is closed; make another one")

    def _draw(self) -> NDArray[np.uint8]:
        frame = np.empty((*self.render_size, 3), np.uint8)
        self._tasks.render(frame[np.newaxis])
        return frame

    def _show(self) -> None:
        if self.render_mode == "human":
            if self._window is None:
                self._window = Window(type(self).__name__, self.metadata["render_fps"])
            self._window.show(self._draw())

    def __getstate__(self) -> dict[str, Any]:
        """Everything but the window, which opens anew."""
        return {**self.__dict__, "_window": None}


class BreakoutEnv(WorldEnv):
    """A paddle keeps a ball in play that breaks bricks out of a wall. The goal is a black picture: no brick is left.

    Actions are "stay", "left" and "right". The variable reward is the number of bricks that a step removes, the score that of
    the episode. The parameters are those of :class:`WorldEnv`, but for the world.
    """

    def __init__(self, **options: Unpack[Options]) -> None:
        super().__init__("breakout", **options)


class FlappyBirdEnv(WorldEnv):
    """A bird falls, flaps and has to fly through the gaps between pipes. The goal is a cut-out of it between two pipes.

    Actions are "glide" and "flap". The variable reward is 1 for a step between two pipes, -1 for the crash and 0.1 for any
    other; the score is the number of pairs that were passed. The parameters are those of :class:`WorldEnv`, but for the world.
    """

    def __init__(self, **options: Unpack[Options]) -> None:
        super().__init__("flappy", **options)


class KobianFaceEnv(WorldEnv):
    """A robot's face is to make an expression; its brows and its mouth move. The goal is the movement of a face that makes it.

    There are 13 actions, of which 0 is "rest". The variable reward is 1 for the expression and 0 as far from it as the
    neutral face is; the score is minus the number of actions that are missing. All episodes begin alike.

    Parameters
    ----------
    expression : {"happy", "surprise"}
    **options
        The parameters of :class:`WorldEnv`, but for the world.
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 4}

    def __init__(self, *, expression: Expression = "happy", **options: Unpack[Options]) -> None:
        super().__init__(face(expression), **options)


def face(expression: Expression) -> World:
    """The world of an expression."""
    choice("expression", expression, ("happy", "surprise"))
    return "kobian-happy" if expression == "happy" else "kobian-surprise"
