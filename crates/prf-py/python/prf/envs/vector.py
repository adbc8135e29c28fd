"""Many environments at once, stepped together in Rust."""

from collections.abc import Sequence
from typing import Any, TypeAlias

import numpy as np
from gymnasium import logger, spaces
from gymnasium.error import ClosedEnvironmentError, InvalidAction, ResetNeeded
from gymnasium.utils import seeding
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from numpy.typing import NDArray
from typing_extensions import Unpack

from prf.envs.options import Expression, GoalLike, Options, Reward, Size, State, World, choice, make_tasks, read_size
from prf.envs.seeds import draw_seed, episode_of
from prf.envs.single import face

Observations: TypeAlias = NDArray[np.uint8]
Actions: TypeAlias = NDArray[np.integer[Any]]


class VectorOptions(Options, total=False):
    """Keyword arguments of every vector environment; :class:`WorldVectorEnv` explains them."""

    num_envs: int
    autoreset_mode: AutoresetMode | str
    threads: int | None


class WorldVectorEnv(VectorEnv[Observations, Actions, NDArray[Any]]):
    """Many environments of one world, stepped together.

    It does what a ``gymnasium.vector.SyncVectorEnv`` of as many :class:`WorldEnv` does, only faster.
    Observations have shape ``(num_envs, 84, 84)``, rewards are ``float64``.

    Parameters
    ----------
    world : {"breakout", "flappy", "kobian-happy", "kobian-surprise"}
        The environments of one world have no such parameter.
    num_envs : int, 1 to 4096
    reward, goal, state, max_episode_steps, render_size
        As for :class:`WorldEnv`.
    render_mode : {"rgb_array"}, optional
    autoreset_mode : gymnasium.vector.AutoresetMode or {"NextStep", "SameStep", "Disabled"}
        When the next episode begins: in the step after the last one, whose action is then ignored; in the same
        step, which hands the last observation over in ``infos["final_obs"]``; or with
        ``reset(options={"reset_mask": mask})``.
    threads : int, 1 to 1024, optional
        The most threads that step them; as many as there are cores, where that pays, if it isn't given. Results are
        the same.

    Raises
    ------
    TypeError, ValueError, OSError
        An argument has another type or is out of range, or a goal can't be read.
    """

    metadata: dict[str, Any] = {
        "render_modes": ["rgb_array"],
        "render_fps": 15,
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }

    def __init__(
        self,
        world: World,
        num_envs: int = 1,
        *,
        reward: Reward = "perceptual",
        goal: GoalLike | None = None,
        state: State | None = None,
        max_episode_steps: int | None = None,
        render_mode: str | None = None,
        render_size: Size = 336,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        threads: int | None = None,
    ) -> None:
        if render_mode is not None:
            choice("render_mode", render_mode, ("rgb_array",))
        self.render_mode = render_mode
        self.render_size = read_size("render_size", render_size)
        """Height and width of rendered frames."""
        self._mode = read_mode(autoreset_mode)
        self.metadata = {**self.metadata, "autoreset_mode": self._mode}
        self._tasks = make_tasks(world, num_envs, reward, goal, state, max_episode_steps, threads)
        self.num_envs = num_envs
        self.single_observation_space = spaces.Box(0, 255, self._tasks.shape, np.uint8)
        self._actions = len(self._tasks.actions)
        self.single_action_space = spaces.Discrete(self._actions)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._all = np.ones(num_envs, np.bool_)
        self._have_begun = np.zeros(num_envs, np.bool_)
        self._random = [seeding.np_random(None) for _ in range(num_envs)]
        # The episodes that begin next, and the environments where one does so in the next step.
        self._seeds = np.zeros(num_envs, np.uint64)
        self._restart: NDArray[np.bool_] | None = None

    @property
    def action_names(self) -> tuple[str, ...]:
        """What the actions are called, in their order."""
        return tuple(self._tasks.actions)

    @property  # type: ignore[misc]
    def np_random(self) -> tuple[np.random.Generator, ...]:  # type: ignore[override]
        """The environments' generators, which draw episodes where no seed is given."""
        return tuple(generator for generator, _ in self._random)

    @property
    def np_random_seed(self) -> tuple[int, ...]:  # type: ignore[override]
        """The seeds of the environments' generators."""
        return tuple(seed for _, seed in self._random)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observations, dict[str, Any]]:
        """Begins an episode in every environment, or where ``options["reset_mask"]`` says so.

        Parameters
        ----------
        seed : int, sequence of int or None, optional
            A seed for each environment, or that of the first: the others get those that follow.
        options : dict, optional
            ``reset_mask``, an array of ``num_envs`` bools: which episodes begin; the others go on.

        Raises
        ------
        TypeError, ValueError
            There is another number of seeds, or the mask is no such array.
        gymnasium.error.Error
            A seed is no integer, or negative. No episode begins then.
        gymnasium.error.ClosedEnvironmentError
            The environment is closed.
        """
        self._check_open()
        mask = self._read_mask(options)
        seeds = self._read_seeds(seed)
        # All of them first, so that nothing has changed where one is refused.
        random = {
            index: seeding.np_random(number) for index, number in enumerate(seeds) if mask[index] and number is not None
        }
        for index in mask.nonzero()[0].tolist():
            number = seeds[index]
            if number is None:
                self._draw_episode(index)
            else:
                self._random[index] = random[index]
                self._seeds[index] = episode_of(number)
        self._have_begun |= mask
        if self._restart is not None:
            self._restart &= ~mask
        return self._begin(mask), {}

    def step(
        self, actions: Actions
    ) -> tuple[Observations, NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Plays a step in every environment.

        Raises
        ------
        TypeError
            The actions are no integers.
        ValueError
            There is another number of them.
        gymnasium.error.InvalidAction
            One is out of range. Nothing is played or drawn then.
        gymnasium.error.ResetNeeded
            An episode has not begun, or is over and there is no autoreset. Nothing is played then.
        gymnasium.error.ClosedEnvironmentError
            The environment is closed.
        """
        self._check_open()
        numbers = self._read_actions(actions)
        restart = self._restart
        if restart is not None:
            self._check_actions(numbers)
            self._draw_episodes(restart)
        observations = self._observations()
        rewards, scores = np.empty(self.num_envs), np.empty(self.num_envs)
        terminated, truncated = np.empty(self.num_envs, np.bool_), np.empty(self.num_envs, np.bool_)
        ends = self._tasks.step(
            numbers, restart, self._seeds, observations, rewards, scores, terminated, truncated
        )
        self._restart = None
        infos = score_info(scores, self._all.copy() if restart is None else ~restart)
        if ends and self._mode is AutoresetMode.NEXT_STEP:
            self._restart = terminated | truncated
        elif ends and self._mode is AutoresetMode.SAME_STEP:
            over = terminated | truncated
            infos = score_info(np.where(over, 0.0, scores), ~over) | final_info(observations, scores, over)
            self._draw_episodes(over)
            observations = self._begin(over)
        return observations, rewards, terminated, truncated, infos

    def render(self) -> tuple[NDArray[np.uint8], ...] | None:
        """A frame of shape ``(height, width, 3)`` of each environment; or None where there is no render mode."""
        if self.render_mode is None:
            logger.warn("render() without a render mode: make the environments with render_mode='rgb_array'")
            return None
        self._check_open()
        if not self._have_begun.all():
            raise ResetNeeded("render: got no episode yet, expected a reset before it")
        frames = np.empty((self.num_envs, *self.render_size, 3), np.uint8)
        self._tasks.render(frames)
        return tuple(frames)

    def _check_open(self) -> None:
        if self.closed:
            raise ClosedEnvironmentError("these environments are closed; make others")

    def _observations(self) -> Observations:
        return np.empty((self.num_envs, *self._tasks.shape), np.uint8)

    def _begin(self, mask: NDArray[np.bool_]) -> Observations:
        observations = self._observations()
        self._tasks.reset(mask, self._seeds, observations)
        return observations

    def _draw_episodes(self, mask: NDArray[np.bool_]) -> None:
        for index in mask.nonzero()[0].tolist():
            self._draw_episode(index)

    def _draw_episode(self, index: int) -> None:
        self._seeds[index] = draw_seed(self._random[index][0])

    def _read_seeds(self, seed: int | Sequence[int | None] | None) -> Sequence[int | None]:
        if seed is None:
            return [None] * self.num_envs
        if isinstance(seed, int):
            return range(seed, seed + self.num_envs)
        try:
            seeds = list(seed)
        except TypeError:
            got = type(seed).__name__
            raise TypeError(f"seed: got {got}, expected an int, a sequence of them or None") from None
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed: got {len(seeds)} of them, expected one for each of {self.num_envs} environments")
        return seeds

    def _read_mask(self, options: dict[str, Any] | None) -> NDArray[np.bool_]:
        if options is None or "reset_mask" not in options:
            return self._all
        expected = f"expected an array of {self.num_envs} bools"
        mask: Any = options["reset_mask"]
        if type(mask) is not np.ndarray:
            raise TypeError(f"reset_mask: got {type(mask).__name__}, {expected}")
        if mask.dtype != np.bool_:
            raise TypeError(f"reset_mask: got an array of {mask.dtype}, {expected}")
        if mask.shape != (self.num_envs,):
            raise ValueError(f"reset_mask: got shape {mask.shape}, {expected}")
        if not mask.any():
            raise ValueError("reset_mask: got no True, expected at least one")
        return np.ascontiguousarray(mask)

    def _read_actions(self, actions: Actions) -> NDArray[np.int64]:
        array = np.asarray(actions)
        expected = f"expected {self.num_envs} integers"
        if array.shape != (self.num_envs,):
            raise ValueError(f"actions: got shape {array.shape}, {expected}")
        if array.dtype.kind not in "iu":
            raise TypeError(f"actions: got an array of {array.dtype}, {expected}")
        if array.dtype == np.uint64:
            self._check_actions(array)  # as int64 the largest would be others
        return np.ascontiguousarray(array, np.int64)

    def _check_actions(self, actions: NDArray[np.integer[Any]]) -> None:
        """Refuses what is out of range where a step is played, before Rust would."""
        is_wrong = (actions < 0) | (actions >= self._actions)
        if self._restart is not None:
            is_wrong &= ~self._restart
        if is_wrong.any():
            index = int(is_wrong.argmax())
            raise InvalidAction(f"actions[{index}]: got {actions[index]}, expected 0 to {self._actions - 1}")


class BreakoutVectorEnv(WorldVectorEnv):
    """Many :class:`BreakoutEnv`. The parameters are those of :class:`WorldVectorEnv`, but for the world."""

    def __init__(self, **options: Unpack[VectorOptions]) -> None:
        super().__init__("breakout", **options)


class FlappyBirdVectorEnv(WorldVectorEnv):
    """Many :class:`FlappyBirdEnv`. The parameters are those of :class:`WorldVectorEnv`, but for the world."""

    def __init__(self, **options: Unpack[VectorOptions]) -> None:
        super().__init__("flappy", **options)


class KobianFaceVectorEnv(WorldVectorEnv):
    """Many :class:`KobianFaceEnv`.

    Parameters
    ----------
    expression : {"happy", "surprise"}
    **options
        The parameters of :class:`WorldVectorEnv`, but for the world.
    """

    metadata: dict[str, Any] = {**WorldVectorEnv.metadata, "render_fps": 4}

    def __init__(self, *, expression: Expression = "happy", **options: Unpack[VectorOptions]) -> None:
        super().__init__(face(expression), **options)


def read_mode(mode: AutoresetMode | str) -> AutoresetMode:
    """A mode, or the one of this name."""
    if isinstance(mode, AutoresetMode):
        return mode
    choice("autoreset_mode", mode, tuple(known.value for known in AutoresetMode))
    return AutoresetMode(mode)


def score_info(scores: NDArray[np.float64], mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Scores, of which the mask says where there are any, as Gymnasium joins the ``info`` of environments."""
    return {"score": scores, "_score": mask} if mask.any() else {}


def final_info(
    observations: Observations, scores: NDArray[np.float64], over: NDArray[np.bool_]
) -> dict[str, Any]:
    """What the episodes that are over came to, as Gymnasium hands it over."""
    final = np.full(len(over), None, object)
    for index in over.nonzero()[0].tolist():
        final[index] = observations[index].copy()
    return {
        "final_obs": final,
        "_final_obs": over.copy(),
        "final_info": score_info(np.where(over, scores, 0.0), over.copy()),
        "_final_info": over.copy(),
    }
