"""A reward from pictures for environments that know nothing of it."""

import copy
import pickle
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from numpy.typing import NDArray
from pictures import natural

import prf
from prf.wrappers import PerceptualReward
from prf.wrappers.vector import PerceptualReward as VectorPerceptualReward

Bytes = NDArray[np.uint8]
Env = gym.Env[Any, Any]

SIDE = 24
MODES = list(AutoresetMode)


class Walk(gym.Env[Bytes, np.int64]):
    """A coloured box walks to the right or rests; the way ends at the border, and after ten steps in any case."""

    metadata: dict[str, Any] = {"render_modes": ["rgb_array", "ansi"], "render_fps": 10}
    observation_space = gym.spaces.Box(0, 255, (SIDE, SIDE, 3), np.uint8)
    action_space = gym.spaces.Discrete(2)

    def __init__(self, render_mode: str | None = None) -> None:
        self.render_mode = render_mode
        self.x = self.y = self.steps = 0

    def picture(self) -> Bytes:
        picture = np.zeros((SIDE, SIDE, 3), np.uint8)
        picture[self.y : self.y + 5, self.x : self.x + 4] = (250, 120, 30)
        picture[self.y + 1, self.x + 1] = (0, 0, 255)
        picture[:, 0] = (90, 90, 90)  # where it comes from
        return picture

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Bytes, dict[str, Any]]:
        super().reset(seed=seed)
        self.x, self.y, self.steps = int(self.np_random.integers(6)), int(self.np_random.integers(SIDE - 5)), 0
        return self.picture(), {"start": self.x}

    def step(self, action: np.int64) -> tuple[Bytes, float, bool, bool, dict[str, Any]]:
        self.x = min(self.x + 3 * int(action), SIDE - 4)
        self.steps += 1
        return self.picture(), -1.5, self.x == SIDE - 4, self.steps == 10, {"x": self.x}

    def render(self) -> Any:
        return self.picture() if self.render_mode == "rgb_array" else "a walk"


def goal_of(kind: str) -> prf.DirectGoal | prf.WindowGoal | prf.MotionGoal:
    """The end of the way."""
    walk = Walk()
    walk.reset(seed=4)
    frames = [prf.to_grey(walk.picture())]
    while walk.x < SIDE - 4:
        frames.append(prf.to_grey(walk.step(np.int64(1))[0]))
    if kind == "motion":
        return prf.MotionGoal(np.stack(frames), cell=0.2)
    if kind == "window":
        return prf.WindowGoal(frames[-1][walk.y : walk.y + 5, walk.x - 3 :], cell_px=2)
    return prf.DirectGoal(frames[-1], cell=0.2)


KINDS = ["direct", "window", "motion"]


def assert_equal(one: object, other: object) -> None:
    assert data_equivalence(one, other, exact=True), (one, other)


@pytest.mark.parametrize("source", ["render", "observation"])
@pytest.mark.parametrize("kind", KINDS)
def test_the_reward_is_that_of_the_frame_and_the_original_is_kept(kind: str, source: Any) -> None:
    goal = goal_of(kind)
    env = PerceptualReward(Walk("rgb_array" if source == "render" else None), goal, source=source)
    walk = Walk()
    rewards: set[float] = set()
    rng = np.random.default_rng(1)
    for seed in range(4):
        observation, info = env.reset(seed=seed)
        assert_equal((observation, info), walk.reset(seed=seed))
        goal.reset(prf.to_grey(observation))
        over = False
        while not over:
            action = rng.integers(0, 2)
            expected = walk.step(action)
            observation, reward, terminated, truncated, info = env.step(action)
            assert reward == goal.reward(prf.to_grey(observation))
            assert_equal((observation, terminated, truncated), (expected[0], *expected[2:4]))
            assert info == {"x": walk.x, "original_reward": -1.5}
            rewards.add(reward)
            over = terminated or truncated
    assert len(rewards) > 1
    assert all(0 < reward <= 1 for reward in rewards)


@pytest.mark.parametrize(
    ("id", "options", "preset"),
    [
        ("PRF/Breakout-v0", {}, "breakout"),
        ("PRF/FlappyBird-v0", {}, "flappy"),
        ("PRF/KobianFace-v0", {"expression": "surprise"}, "kobian-surprise-kprf"),
    ],
)
def test_it_gives_what_the_environments_of_prf_give(id: str, options: dict[str, Any], preset: str) -> None:
    own = gym.make(id, **options)
    plain = gym.make(id, reward="variable", render_mode="rgb_array", render_size=84, **options)
    env = PerceptualReward(plain, prf.preset_goal(preset))
    scores = gym.make(id, reward="variable", **options)
    env.action_space.seed(1)
    for seed in range(3):
        for each in (own, env, scores):
            each.reset(seed=seed)
        over = False
        while not over:
            action = env.action_space.sample()
            _, reward, terminated, truncated, info = own.step(action)
            step = env.step(action)
            assert (step[1], step[2], step[3]) == (reward, terminated, truncated)
            assert step[4] == {**info, "original_reward": scores.step(action)[1]}
            over = terminated or truncated


def test_any_environment_of_gymnasium_can_be_wrapped() -> None:
    goal = natural(100, 150)
    for id in ("CartPole-v1", "FrozenLake-v1", "MountainCarContinuous-v0"):
        env = PerceptualReward(gym.make(id, render_mode="rgb_array"), goal, size=(100, 150))
        env.reset(seed=1)
        env.action_space.seed(1)
        _, reward, *_, info = env.step(env.action_space.sample())
        frame: Any = env.render()
        assert reward == prf.reward(goal, prf.to_grey(frame, size=(100, 150)))
        assert float(info["original_reward"]) != reward
        env.close()


def test_gymnasium_s_own_checks_pass() -> None:
    for kind in KINDS:
        env = PerceptualReward(Walk("rgb_array"), goal_of(kind))
        with pytest.warns(UserWarning, match="different from the unwrapped version|does not have a spec|not having a spec"):
            check_env(env)


@pytest.mark.parametrize("kind", KINDS)
def test_goals_may_be_made_here(kind: Any) -> None:
    goal = goal_of(kind)
    picture = goal.goal
    cls: Any = type(goal)
    one, other = (PerceptualReward(Walk("rgb_array"), each, descriptor=kind) for each in (picture, cls(picture)))
    for env in (one, other):
        env.reset(seed=2)
    assert type(one.goal) is cls
    for _ in range(3):
        assert_equal(one.step(np.int64(1)), other.step(np.int64(1)))
    assert isinstance(PerceptualReward(Walk("rgb_array"), natural(9, 9)).goal, prf.DirectGoal)


def test_frames_may_be_brought_to_a_size() -> None:
    goal = prf.DirectGoal(natural(40, 50))
    for size, shape in [(40, (40, 40)), ((40, 50), (40, 50))]:
        env = PerceptualReward(Walk("rgb_array"), goal, size=size)  # type: ignore[arg-type]
        env.reset(seed=1)
        observation, reward, *_ = env.step(np.int64(1))
        assert reward == goal.reward(prf.to_grey(observation, size=shape))


def test_two_wrappers_keep_the_reward_of_the_environment_itself() -> None:
    goals = goal_of("direct"), goal_of("window")
    env = PerceptualReward(PerceptualReward(Walk("rgb_array"), goals[0]), goals[1])
    env.reset(seed=1)
    observation, reward, *_, info = env.step(np.int64(1))
    assert (reward, info["original_reward"]) == (goals[1].reward(prf.to_grey(observation)), -1.5)
    together = SyncVectorEnv([lambda: Walk("rgb_array")] * 2)
    vector = VectorPerceptualReward(VectorPerceptualReward(together, goals[0]), goals[1])
    vector.reset(seed=1)
    assert vector.step(np.array([1, 1]))[4]["original_reward"].tolist() == [-1.5, -1.5]


def test_the_goal_that_was_given_is_left_alone() -> None:
    goal = goal_of("motion")
    state = goal.__getstate__()
    envs = [PerceptualReward(Walk("rgb_array"), goal) for _ in range(2)]
    vector = VectorPerceptualReward(SyncVectorEnv([lambda: Walk("rgb_array")] * 2), goal)
    rewards: list[list[float]] = []
    for env in envs:
        env.reset(seed=1)
    vector.reset(seed=1)
    for _ in range(3):
        rewards.append([env.step(np.int64(1))[1] for env in envs])
        vector.step(np.array([1, 0]))
    assert goal.__getstate__() == state
    assert all(one == other for one, other in rewards)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("way", ["pickle", "deepcopy"])
def test_copies_go_on_in_the_same_way(kind: str, way: str) -> None:
    env = PerceptualReward(Walk("rgb_array"), goal_of(kind))
    vector = VectorPerceptualReward(SyncVectorEnv([lambda: Walk("rgb_array")] * 2), goal_of(kind))
    env.reset(seed=1)
    env.step(np.int64(1))
    copied = copy.deepcopy(env) if way == "deepcopy" else pickle.loads(pickle.dumps(env))
    assert_equal(env.step(np.int64(1)), copied.step(np.int64(1)))
    assert copied.goal is not env.goal
    if way == "deepcopy":  # a SyncVectorEnv of lambdas can't be pickled
        vector.reset(seed=1)
        vector.step(np.array([1, 1]))
        vector_copy = copy.deepcopy(vector)
        assert_equal(vector.step(np.array([1, 0])), vector_copy.step(np.array([1, 0])))


def test_an_environment_s_spec_makes_it_again() -> None:
    env = PerceptualReward(gym.make("PRF/Breakout-v0", reward="variable", render_mode="rgb_array"), natural(84, 84), size=84)
    assert env.spec is not None
    again = gym.make(env.spec)
    assert isinstance(again, PerceptualReward)
    for each in (env, again):
        each.reset(seed=3)
    assert_equal(env.step(1), again.step(1))


@pytest.mark.parametrize(
    ("make", "error", "message"),
    [
        (lambda: PerceptualReward(Walk(), natural(9, 9)), ValueError, "env: got render_mode=None, expected 'rgb_array'"),
        (lambda: PerceptualReward(Walk("ansi"), natural(9, 9)), ValueError, "env: got render_mode='ansi', expected"),
        (
            lambda: PerceptualReward(gym.make("CartPole-v1"), natural(9, 9), source="observation"),
            ValueError,
            r"env: got observations of Box\(.*, expected a Box of uint8 with shape \(height, width\)",
        ),
        (
            lambda: PerceptualReward(gym.make("FrozenLake-v1"), natural(9, 9), source="observation"),
            ValueError,
            r"env: got observations of Discrete\(16\), expected a Box",
        ),
        (lambda: PerceptualReward(Walk("rgb_array"), natural(9, 9), source="frames"), ValueError, "source: got 'frames'"),  # type: ignore[arg-type]
        (lambda: PerceptualReward(Walk("rgb_array"), natural(9, 9), descriptor="hog"), ValueError, "descriptor: got 'hog'"),  # type: ignore[arg-type]
        (
            lambda: PerceptualReward(Walk("rgb_array"), goal_of("window"), descriptor="direct"),
            ValueError,
            "descriptor: got 'direct' with a WindowGoal",
        ),
        (lambda: PerceptualReward(Walk("rgb_array"), natural(9, 9), size=0), ValueError, "size: got 0, expected"),
        (
            lambda: PerceptualReward(Walk("rgb_array"), natural(9, 21), descriptor="window", size=(30, 20)),
            ValueError,
            "goal: got a window of 21x9 px, expected one that fits into frames of 20x30 px",
        ),
        (
            lambda: PerceptualReward(Walk(), natural(25, 9), descriptor="window", source="observation"),
            ValueError,
            "goal: got a window of 9x25 px, expected one that fits into frames of 24x24 px",
        ),
        (
            lambda: VectorPerceptualReward(SyncVectorEnv([Walk]), natural(25, 9), descriptor="window", source="observation"),
            ValueError,
            "goal: got a window of 9x25 px",
        ),
        (lambda: PerceptualReward(Walk("rgb_array"), "nowhere.png"), FileNotFoundError, "nowhere.png"),
        (lambda: PerceptualReward(Walk("rgb_array"), None), TypeError, "goal: got NoneType, expected"),  # type: ignore[arg-type]
        (lambda: PerceptualReward("Walk", natural(9, 9)), TypeError, "env|Env|render_mode"),  # type: ignore[arg-type]
        (
            lambda: VectorPerceptualReward(SyncVectorEnv([Walk]), natural(9, 9)),
            ValueError,
            "env: got render_mode=None, expected 'rgb_array'",
        ),
        (
            lambda: VectorPerceptualReward(
                SyncVectorEnv([lambda: Walk("rgb_array")], autoreset_mode=AutoresetMode.SAME_STEP), natural(9, 9)
            ),
            ValueError,
            "source: got 'render' with the autoreset mode SAME_STEP",
        ),
    ],
)
def test_what_does_not_fit_is_refused(make: Callable[[], object], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        make()


def test_frames_that_are_no_pictures_are_refused() -> None:
    class Odd(Walk):
        frame: Any = None

        def render(self) -> Any:
            return self.frame

    env = PerceptualReward(Odd("rgb_array"), natural(30, 30), descriptor="window")
    odd: Any = env.env
    for frame, error, message in [
        (None, TypeError, r"render\(\): got NoneType, expected an array of shape \(height, width\)"),
        ([[1]], TypeError, r"render\(\): got list, expected an array"),
        (np.zeros((9, 9, 2), np.uint8), ValueError, r"image: got shape \(9, 9, 2\), expected"),
        (np.zeros((9, 9, 3)), TypeError, "image: got an array of float64, expected uint8"),
        (np.zeros((0, 9, 3), np.uint8), ValueError, r"image: got shape \(0, 9, 3\)"),
        (np.zeros((20, 40, 3), np.uint8), ValueError, "frame: .*30x30"),
    ]:
        odd.frame = frame
        with pytest.raises(error, match=message):
            env.reset()
    vector = VectorPerceptualReward(SyncVectorEnv([lambda: Odd("rgb_array")]), natural(30, 30))
    with pytest.raises(TypeError, match=r"render\(\): got NoneType"):
        vector.reset()


def test_frames_of_a_motion_have_one_size() -> None:
    class Growing(Walk):
        def render(self) -> Any:
            return self.picture()[: SIDE - self.steps]

    env = PerceptualReward(Growing("rgb_array"), goal_of("motion"))
    env.reset()
    with pytest.raises(ValueError, match="frame: .*24x23"):
        env.step(np.int64(1))


def vectors(mode: AutoresetMode, goal: Any, source: Any) -> tuple[Any, Any]:
    """Wrapped together, and one by one."""
    render_mode = "rgb_array" if source == "render" else None
    together = SyncVectorEnv([lambda: Walk(render_mode)] * 4, autoreset_mode=mode)
    alone = [lambda: PerceptualReward(Walk(render_mode), goal, source=source)] * 4
    return VectorPerceptualReward(together, goal, source=source), SyncVectorEnv(alone, autoreset_mode=mode)


@pytest.mark.parametrize(
    ("mode", "source"),
    [
        (AutoresetMode.NEXT_STEP, "render"),
        (AutoresetMode.NEXT_STEP, "observation"),
        (AutoresetMode.SAME_STEP, "observation"),
        (AutoresetMode.DISABLED, "render"),
        (AutoresetMode.DISABLED, "observation"),
    ],
)
@pytest.mark.parametrize("kind", KINDS)
def test_many_are_rewarded_as_each_alone(kind: str, mode: AutoresetMode, source: str) -> None:
    together, alone = vectors(mode, goal_of(kind), source)
    assert_equal(together.reset(seed=3), alone.reset(seed=3))
    rng = np.random.default_rng(1)
    ends = 0
    for number in range(120):
        actions = rng.integers(0, 2, 4)
        got, expected = together.step(actions), alone.step(actions)
        assert_equal(got, expected)
        mask = got[2] | got[3]
        ends += mask.sum()
        if mode is AutoresetMode.DISABLED and mask.any() or number % 17 == 0:
            mask[number % 4] = True
            resets = [envs.reset(seed=number, options={"reset_mask": mask.copy()}) for envs in (together, alone)]
            assert_equal(*resets)
    assert ends > 20
    assert_equal(together.reset(), alone.reset())


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(("id", "preset"), [("PRF/FlappyBird-v0", "flappy"), ("PRF/KobianFace-v0", "kobian-happy-kprf")])
def test_native_environments_get_what_is_built_in(id: str, preset: str, mode: AutoresetMode) -> None:
    options: dict[str, Any] = {"num_envs": 3, "autoreset_mode": mode, "max_episode_steps": 8, "state": "mirror"}
    own = gym.make_vec(id, **options)
    plain = gym.make_vec(id, reward="variable", **options)
    originals = gym.make_vec(id, reward="variable", **options)
    envs = VectorPerceptualReward(plain, prf.preset_goal(preset), source="observation")
    for each in (own, envs, originals):
        each.reset(seed=5)
    for _ in range(40):
        actions: Any = getattr(envs, "action_space").sample()
        expected, got, original = own.step(actions), envs.step(actions), originals.step(actions)
        assert_equal(got[:4], expected[:4])
        infos = got[4]
        rewards = np.where(infos.get("_original_reward", False), infos.get("original_reward", 0), 0)
        final = infos.get("final_info", {})
        rewards = rewards + np.where(final.get("_original_reward", False), final.get("original_reward", 0), 0)
        np.testing.assert_array_equal(rewards, original[1])
        mask = got[2] | got[3]
        if mode is AutoresetMode.DISABLED and mask.any():
            for each in (own, envs, originals):
                each.reset(options={"reset_mask": mask})


def test_vector_environments_of_gymnasium_can_be_wrapped() -> None:
    goal = natural(100, 150)
    plain = gym.make_vec("CartPole-v1", 2, vectorization_mode="vector_entry_point", render_mode="rgb_array")
    envs = VectorPerceptualReward(plain, goal, size=(100, 150))
    envs.reset(seed=1)
    _, rewards, *_, infos = envs.step(np.array([0, 1]))
    frames: Any = envs.render()
    assert rewards.tolist() == [prf.reward(goal, prf.to_grey(frame, size=(100, 150))) for frame in frames]
    assert infos["original_reward"].tolist() == [1, 1]
    envs.close()


def test_a_mode_that_is_missing_is_assumed_aloud() -> None:
    envs = SyncVectorEnv([lambda: Walk("rgb_array")])
    del envs.metadata["autoreset_mode"]
    with pytest.warns(UserWarning, match="autoreset_mode.* is missing, NEXT_STEP is assumed"):
        VectorPerceptualReward(envs, natural(9, 9))
