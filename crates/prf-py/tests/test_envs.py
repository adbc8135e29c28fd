"""Environments keep to what Gymnasium and they themselves promise."""

import copy
import itertools
import pickle
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cloudpickle as untyped_cloudpickle  # type: ignore[import-untyped]
import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ClosedEnvironmentError, InvalidAction, ResetNeeded
from gymnasium.utils.env_checker import check_env, data_equivalence
from pictures import natural

import prf
from prf._native import Tasks
from prf.envs import BreakoutEnv, FlappyBirdEnv, KobianFaceEnv, WorldEnv

Env = gym.Env[Any, Any]

IDS = ["PRF/Breakout-v0", "PRF/FlappyBird-v0", "PRF/KobianFace-v0"]
CLASSES: list[Any] = [BreakoutEnv, FlappyBirdEnv, KobianFaceEnv]
STATES = ["mirror", "ema", "motion"]
REWARDS = ["perceptual", "variable"]


def play(env: Env, actions: list[int]) -> list[Any]:
    """What steps give, with a new episode where one is over."""
    results: list[Any] = []
    for action in actions:
        step = env.step(action)
        results.append(step)
        if step[2] or step[3]:
            results.append(env.reset())
    return results


def actions_of(env: Env, count: int, seed: int = 5) -> list[int]:
    space = env.action_space
    assert isinstance(space, gym.spaces.Discrete)
    return [int(action) for action in np.random.default_rng(seed).integers(0, int(space.n), count)]


def assert_equal(one: object, other: object) -> None:
    assert data_equivalence(one, other, exact=True)


@pytest.mark.parametrize(("id", "reward", "state"), list(itertools.product(IDS, REWARDS, [None, *STATES])))
def test_gymnasium_s_own_checks_pass(id: str, reward: str, state: str | None) -> None:
    """Warnings are errors here."""
    check_env(gym.make(id, reward=reward, state=state, render_mode="rgb_array").unwrapped)


@pytest.mark.parametrize(("id", "limit", "actions"), list(zip(IDS, [100, 5000, 10], [3, 2, 13], strict=True)))
def test_ids_are_registered(id: str, limit: int, actions: int) -> None:
    assert gym.spec(id).max_episode_steps == limit
    env = gym.make(id)
    assert env.observation_space == gym.spaces.Box(0, 255, (84, 84), np.uint8)
    assert env.action_space == gym.spaces.Discrete(actions)
    assert len(env.get_wrapper_attr("action_names")) == actions
    assert isinstance(env.unwrapped, WorldEnv)


def python(code: str) -> str:
    run = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr
    return run.stdout


def test_an_id_may_name_the_package_to_import() -> None:
    code = "import gymnasium as gym; print(gym.make('prf:PRF/Breakout-v0'), gym.make_vec('prf:PRF/FlappyBird-v0', 2))"
    out = python(code)
    assert "<BreakoutEnv<PRF/Breakout-v0>>" in out
    assert "FlappyBirdVectorEnv(PRF/FlappyBird-v0, num_envs=2)" in out


def test_gymnasium_is_not_needed() -> None:
    python(
        "import sys; sys.modules['gymnasium'] = None\n"
        "import numpy as np, prf\n"
        "assert prf.reward(np.zeros((9, 9), np.uint8), np.zeros((9, 9), np.uint8)) == 1\n"
        "for name in ('envs', 'wrappers'):\n"
        "    try:\n"
        "        getattr(prf, name)\n"
        "    except ModuleNotFoundError as error:\n"
        "        assert 'pip install \"prf-py[gymnasium]\"' in str(error), error\n"
        "    else:\n"
        "        raise AssertionError(name)\n"
    )


@pytest.mark.parametrize("version", ["0.26.3", "0.29.1", "1.0.0"])
def test_an_old_gymnasium_is_not_used(version: str, tmp_path: Path) -> None:
    (tmp_path / "gymnasium").mkdir()
    (tmp_path / "gymnasium/__init__.py").write_text("raise TypeError('old')")
    (tmp_path / f"gymnasium-{version}.dist-info").mkdir()
    (tmp_path / f"gymnasium-{version}.dist-info/METADATA").write_text(f"Name: gymnasium\nVersion: {version}\n")
    python(
        f"import sys; sys.path.insert(0, {str(tmp_path)!r})\n"
        "import numpy as np, prf\n"
        "assert prf.hog(np.zeros((9, 9), np.uint8), cell_px=3).shape == (81,)\n"
        "for name in ('envs', 'wrappers'):\n"
        "    try:\n"
        "        getattr(prf, name)\n"
        "    except ImportError as error:\n"
        f"        assert 'prf.' + name + ': got Gymnasium {version}, expected 1.1 or newer' in str(error), error\n"
        "    else:\n"
        "        raise AssertionError(name)\n"
    )


def test_environments_are_imported_when_they_are_asked_for() -> None:
    code = "import sys, prf\nassert 'prf.envs' not in sys.modules and 'pygame' not in sys.modules\nprf.envs.BreakoutEnv()"
    python(code)
    with pytest.raises(AttributeError, match="module 'prf' has no attribute 'rewrad'"):
        prf.rewrad  # type: ignore[attr-defined]


@pytest.mark.parametrize("id", IDS)
def test_gymnasium_truncates_after_any_number_of_steps(id: str) -> None:
    for limit in (3, 12):
        env = gym.make(id, max_episode_steps=limit)
        env.reset(seed=1)
        steps = [env.step(0) for _ in range(3)]
        assert [truncated for _, _, _, truncated, _ in steps] == [False, False, limit == 3]
    env = gym.make("PRF/KobianFace-v0", max_episode_steps=-1)
    env.reset()
    assert not any(env.step(0)[3] for _ in range(30))


def test_an_environment_truncates_by_itself_if_told() -> None:
    env = KobianFaceEnv(max_episode_steps=2)
    env.reset()
    assert [env.step(1)[2:4] for _ in range(2)] == [(False, False), (False, True)]
    with pytest.raises(ResetNeeded, match="the episode of kobian-happy is over: expected a reset"):
        env.step(1)
    env.reset()
    env.step(1)


@pytest.mark.parametrize(("id", "reward", "state"), list(itertools.product(IDS, REWARDS, STATES)))
def test_the_same_seed_and_actions_give_the_same_episodes(id: str, reward: str, state: str) -> None:
    one, other = (gym.make(id, reward=reward, state=state) for _ in range(2))
    actions = actions_of(one, 60)
    assert_equal(one.reset(seed=9), other.reset(seed=9))
    first = play(one, actions)
    assert_equal(first, play(other, actions))
    one.reset(seed=9)
    assert_equal(first, play(one, actions))


def test_seeds_are_episodes_of_the_world() -> None:
    env = gym.make("PRF/Breakout-v0", state="mirror")
    frames = {seed: env.reset(seed=seed)[0].tobytes() for seed in (0, 1, 2, 2**63, 2**64 - 1, 2**64, 2**64 + 1)}
    assert len(set(frames.values())) == 5
    assert (frames[2**64], frames[2**64 + 1]) == (frames[0], frames[1])
    for seed in (-1, 1.5, "1"):
        wrong: Any = seed
        with pytest.raises(gym.error.Error, match="[Ss]eed"):
            env.reset(seed=wrong)


def test_episodes_without_a_seed_are_drawn_from_the_last_one() -> None:
    env = gym.make("PRF/FlappyBird-v0", state="mirror")
    runs: list[list[Any]] = []
    for _ in range(2):
        first = env.reset(seed=4)[0]
        runs.append([first, *(env.reset()[0] for _ in range(4))])
    assert_equal(runs[0], runs[1])
    assert len({frame.tobytes() for frame in runs[0]}) > 3
    assert env.np_random_seed == 4


def test_results_belong_to_the_caller() -> None:
    for state in STATES:
        env = gym.make("PRF/Breakout-v0", state=state)
        kept = [env.reset(seed=1)[0], *(env.step(1)[0] for _ in range(4))]
        copies = [observation.copy() for observation in kept]
        for observation in kept:
            assert observation.flags.owndata and observation.flags.writeable
        env.step(2)[0][:] = 7
        assert_equal(kept, copies)
        assert env.step(0)[0].max() > 7


@pytest.mark.parametrize("state", STATES)
def test_states_are_those_of_frames(state: str) -> None:
    frames = gym.make("PRF/KobianFace-v0", state="mirror")
    env = gym.make("PRF/KobianFace-v0", state=state)
    goal = prf.preset_goal("kobian-happy-kprf")
    assert isinstance(goal, prf.MotionGoal)
    motion = prf.MotionTemplate(
        threshold=goal.threshold,
        tau_start=goal.tau_start,
        tau_step=goal.tau_step,
        delta_divisor=goal.delta_divisor,
        skip_still=goal.skip_still,
    )
    ema = prf.EmaState()
    for episode in range(2):
        motion.reset()
        ema.reset()
        pairs = [(frames.reset(seed=episode)[0], env.reset(seed=episode)[0])]
        pairs += [(frames.step(action)[0], env.step(action)[0]) for action in (1, 7, 0, 11, 9)]
        for frame, observation in pairs:
            expected = {"mirror": frame, "ema": ema.update(frame), "motion": motion.update(frame)}[state]
            np.testing.assert_array_equal(observation, expected)


def test_goals_may_be_given_in_any_form() -> None:
    picture = np.zeros((84, 84), np.uint8)
    picture[10:20, 30:50] = 200
    own = prf.preset_goal("breakout")
    goals: list[Any] = [picture, prf.DirectGoal(picture, cell=own.cell, norm=own.norm)]
    runs: list[list[Any]] = []
    for goal in goals:
        env = gym.make("PRF/Breakout-v0", goal=goal)
        env.reset(seed=2)
        runs.append([env.step(0)[1] for _ in range(5)])
    assert runs[0] == runs[1]
    env = gym.make("PRF/Breakout-v0", goal=prf.WindowGoal(natural(9, 12), norm="none"), state="mirror")
    env.reset(seed=2)
    observation, reward, *_ = env.step(0)
    assert reward == prf.WindowGoal(natural(9, 12), norm="none").reward(observation)


def test_a_goal_that_was_given_keeps_its_own_episode() -> None:
    goal, untouched = prf.preset_goal("kobian-happy-kprf"), prf.preset_goal("kobian-happy-kprf")
    frame = natural(84, 84)
    goal.reset(frame)
    env = gym.make("PRF/KobianFace-v0", goal=goal)
    env.reset()
    env.step(1)
    untouched.reset(frame)
    assert goal.reward(frame[::-1].copy()) == untouched.reward(frame[::-1].copy())


@pytest.mark.parametrize("cls", CLASSES)
def test_steps_before_a_reset_and_after_closing_are_refused(cls: Any) -> None:
    env = cls(render_mode="rgb_array")
    with pytest.raises(ResetNeeded, match="has no episode yet: expected a reset before the first step"):
        env.step(0)
    with pytest.raises(ResetNeeded, match="expected a reset"):
        env.render()
    with pytest.raises(ResetNeeded):
        gym.make(IDS[CLASSES.index(cls)]).step(0)
    env.reset()
    env.close()
    env.close()
    for call in (env.reset, lambda: env.step(0), env.render):
        with pytest.raises(ClosedEnvironmentError, match="closed"):
            call()


@pytest.mark.parametrize("action", [-1, 3, 2**40, 2**100, -(2**100), np.int64(3), np.array(7)])
def test_actions_out_of_range_are_refused(action: Any) -> None:
    env = BreakoutEnv()
    env.reset(seed=1)
    with pytest.raises(InvalidAction, match=f"action: got {int(action)}, expected 0 to 2"):
        env.step(action)


@pytest.mark.parametrize(
    "action", [1.0, np.float64(1), float("nan"), "1", None, [1], np.array([1]), np.array([0, 1]), np.array(1.0), 1j]
)
def test_actions_that_are_no_integers_are_refused(action: Any) -> None:
    env = BreakoutEnv()
    first = env.reset(seed=1)[0]
    with pytest.raises(TypeError, match="action: got .*, expected an integer"):
        env.step(action)
    other = BreakoutEnv()
    assert_equal(first, other.reset(seed=1)[0])
    assert_equal(env.step(1), other.step(1))


@pytest.mark.parametrize("action", [1, True, np.uint8(1), np.int32(1), np.int64(1), np.array(1)])
def test_actions_may_be_any_integers(action: Any) -> None:
    env, other = BreakoutEnv(), BreakoutEnv()
    env.reset(seed=1)
    other.reset(seed=1)
    assert_equal(env.step(action), other.step(1))


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"reward": "points"}, ValueError, "reward: got 'points', expected one of 'perceptual', 'variable'"),
        ({"state": "pixels"}, ValueError, "state: got 'pixels', expected one of 'ema', 'mirror', 'motion'"),
        ({"state": 3}, TypeError, "state: got int, expected a str"),
        ({"goal": 3}, TypeError, "goal: got int, expected"),
        ({"goal": np.zeros((9, 9))}, TypeError, "goal: got an array of float64, expected uint8"),
        ({"goal": np.zeros((2, 9, 9), np.uint8)}, ValueError, r"goal: got shape \(2, 9, 9\)"),
        ({"goal": "nowhere.png"}, FileNotFoundError, "nowhere.png"),
        ({"goal": np.ones((9, 9), np.uint8), "reward": "variable"}, ValueError, "goal: got ndarray, expected None"),
        ({"goal": prf.WindowGoal(natural(90, 20))}, ValueError, "goal: .*20x90"),
        ({"max_episode_steps": 0}, ValueError, "max_episode_steps: got 0, expected 1 to 4294967295"),
        ({"max_episode_steps": 2**32}, ValueError, "max_episode_steps: got 4294967296, expected 1 to 4294967295"),
        ({"max_episode_steps": -1}, ValueError, "max_episode_steps: got -1, expected an int of at least 1"),
        ({"max_episode_steps": 2.5}, TypeError, "max_episode_steps: got float, expected an int of at least 1"),
        ({"render_mode": "ansi"}, ValueError, "render_mode: got 'ansi', expected one of 'human', 'rgb_array'"),
        ({"render_size": 0}, ValueError, r"render_size: got 0, expected a side or \(height, width\) of 1 to 4096"),
        ({"render_size": (84, 5000)}, ValueError, r"render_size: got \(84, 5000\), expected"),
        ({"render_size": (84, 84, 3)}, ValueError, r"render_size: got \(84, 84, 3\), expected"),
        ({"render_size": 84.0}, TypeError, "render_size: got 84.0, expected"),
        ({"render_size": "large"}, TypeError, "render_size: got 'large', expected"),
        ({"size": 84}, TypeError, "unexpected keyword argument 'size'"),
    ],
)
def test_options_out_of_range_are_refused(options: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        BreakoutEnv(**options)


def test_expressions_are_named() -> None:
    wrong: Any = "sad"
    with pytest.raises(ValueError, match="expression: got 'sad', expected one of 'happy', 'surprise'"):
        KobianFaceEnv(expression=wrong)
    with pytest.raises(ValueError, match="world: got 'pong', expected one of 'breakout', 'flappy'"):
        WorldEnv("pong")  # type: ignore[arg-type]


cloudpickle: Any = untyped_cloudpickle
COPIES: dict[str, Callable[[Any], Any]] = {
    "pickle": lambda env: pickle.loads(pickle.dumps(env)),
    "cloudpickle": lambda env: cloudpickle.loads(cloudpickle.dumps(env)),
    "deepcopy": copy.deepcopy,
}


@pytest.mark.parametrize("way", COPIES)
@pytest.mark.parametrize(("id", "state"), list(itertools.product(IDS, STATES)))
def test_copies_go_on_in_the_same_way(id: str, state: str, way: str) -> None:
    env = gym.make(id, state=state, render_mode="rgb_array")
    actions = actions_of(env, 40)
    fresh = COPIES[way](env)
    env.reset(seed=3)
    play(env, actions[:7])
    copied = COPIES[way](env)
    assert_equal(env.render(), copied.render())
    went_on = play(env, actions[7:])
    assert_equal(went_on, play(copied, actions[7:]))
    fresh.reset(seed=3)
    play(fresh, actions[:7])
    assert_equal(went_on, play(fresh, actions[7:]))


def test_damaged_copies_are_refused() -> None:
    tasks = Tasks("breakout", num_envs=2)
    state = tasks.__getstate__()
    for damaged in (b"", state[:-1], state + b"\0", b"x" * len(state), Tasks("flappy", num_envs=2).__getstate__()):
        with pytest.raises(ValueError, match="state: "):
            tasks.__setstate__(damaged)
    assert tasks.__getstate__() == state


def test_environments_live_in_other_processes() -> None:
    apart = gym.make_vec(
        "PRF/Breakout-v0", 2, vectorization_mode="async", vector_kwargs={"context": "spawn"}, goal=prf.preset_goal("breakout")
    )
    together = gym.make_vec("PRF/Breakout-v0", 2, vectorization_mode="sync")
    try:
        assert_equal(apart.reset(seed=6), together.reset(seed=6))
        for action in actions_of(gym.make("PRF/Breakout-v0"), 30):
            assert_equal(apart.step(np.array([action, 0])), together.step(np.array([action, 0])))
    finally:
        apart.close()


def test_an_episode_that_gymnasium_truncates_goes_on_where_it_is_stepped() -> None:
    env = gym.make("PRF/KobianFace-v0", max_episode_steps=2)
    env.reset(seed=1)
    assert [env.step(0)[3] for _ in range(3)] == [False, True, True]
