"""Vector environments do what as many single ones do."""

import copy
import pickle
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ClosedEnvironmentError, InvalidAction, ResetNeeded
from gymnasium.utils.env_checker import data_equivalence
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers.vector import RecordEpisodeStatistics
from numpy.typing import NDArray

import prf
from prf._native import Tasks
from prf.envs import BreakoutVectorEnv, FlappyBirdVectorEnv, KobianFaceVectorEnv, WorldVectorEnv

Envs = gym.vector.VectorEnv[Any, Any, Any]

IDS = ["PRF/Breakout-v0", "PRF/FlappyBird-v0", "PRF/KobianFace-v0"]
MODES = list(AutoresetMode)


def pair(id: str, mode: AutoresetMode, count: int, **options: Any) -> tuple[Envs, Envs]:
    """The native environments, and single ones side by side."""
    native = gym.make_vec(id, count, autoreset_mode=mode, **options)
    assert isinstance(native, WorldVectorEnv)
    single = gym.make_vec(id, count, vectorization_mode="sync", vector_kwargs={"autoreset_mode": mode}, **options)
    return native, single


def actions_of(envs: Envs, steps: int, seed: int = 3) -> NDArray[np.int64]:
    space: Any = getattr(envs, "single_action_space")
    return np.random.default_rng(seed).integers(0, int(space.n), (steps, envs.num_envs))


def assert_equal(one: object, other: object) -> None:
    assert data_equivalence(one, other, exact=True), (one, other)


def go_on(envs: Envs, step: tuple[Any, ...], mode: AutoresetMode) -> Any:
    """Without autoreset, begins the episodes that have to."""
    over = step[2] | step[3]
    if mode is AutoresetMode.DISABLED and over.any():
        return envs.reset(options={"reset_mask": over})
    return None


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(
    ("id", "options"),
    [
        ("PRF/Breakout-v0", {"reward": "variable", "state": "mirror"}),
        ("PRF/Breakout-v0", {"reward": "variable", "state": "ema", "max_episode_steps": 13}),
        ("PRF/Breakout-v0", {}),
        ("PRF/FlappyBird-v0", {"reward": "variable", "state": "motion"}),
        ("PRF/FlappyBird-v0", {"max_episode_steps": 21}),
        ("PRF/KobianFace-v0", {"reward": "variable", "expression": "surprise"}),
        ("PRF/KobianFace-v0", {"state": "ema"}),
    ],
)
def test_they_do_what_single_environments_do(id: str, options: dict[str, Any], mode: AutoresetMode) -> None:
    native, single = pair(id, mode, 5, **options)
    assert_equal(native.reset(seed=11), single.reset(seed=11))
    ends = np.zeros(2, np.int64)
    for actions in actions_of(native, 300):
        got, expected = native.step(actions), single.step(actions)
        assert_equal(got, expected)
        assert_equal(go_on(native, got, mode), go_on(single, expected, mode))
        ends += got[2].sum(), got[3].sum()
    assert ends.sum() > 10
    assert bool(ends[0]) is ("Kobian" not in id)
    assert_equal(native.reset(), single.reset())
    seeds: Any = [5, None, 6, None, 5]
    assert_equal(native.reset(seed=seeds), single.reset(seed=seeds))
    assert_equal(native.step(actions_of(native, 1)[0]), single.step(actions_of(native, 1)[0]))


@pytest.mark.parametrize("mode", MODES)
def test_some_environments_can_be_reset_alone(mode: AutoresetMode) -> None:
    native, single = pair("PRF/Breakout-v0", mode, 4, reward="variable", max_episode_steps=6)
    native.reset(seed=1)
    single.reset(seed=1)
    masks = np.random.default_rng(0).random((40, 4)) < 0.3
    for number, (actions, mask) in enumerate(zip(actions_of(native, 40), masks, strict=True)):
        got, expected = native.step(actions), single.step(actions)
        assert_equal(got, expected)
        mask |= (got[2] | got[3]) if mode is AutoresetMode.DISABLED else False
        if mask.any():
            seed: Any = [None, number, None, 7 * number] if number % 3 else None
            options = {"reset_mask": mask.copy()}
            assert_equal(native.reset(seed=seed, options=options), single.reset(seed=seed, options=dict(options)))
            np.testing.assert_array_equal(options["reset_mask"], mask)


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("id", IDS)
def test_statistics_of_episodes_are_the_same(id: str, mode: AutoresetMode) -> None:
    native, single = (RecordEpisodeStatistics(envs) for envs in pair(id, mode, 3, reward="variable", max_episode_steps=10))
    for envs in (native, single):
        envs.reset(seed=8)
    for actions in actions_of(native, 60):
        for envs in (native, single):
            go_on(envs, envs.step(actions), mode)
    assert native.episode_count == single.episode_count > 5
    assert list(native.return_queue) == list(single.return_queue)
    assert list(native.length_queue) == list(single.length_queue)


def test_the_mode_is_declared() -> None:
    for mode in MODES:
        for given in (mode, mode.value):
            assert BreakoutVectorEnv(autoreset_mode=given).metadata["autoreset_mode"] is mode
    assert gym.make_vec("PRF/Breakout-v0").metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    assert BreakoutVectorEnv.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP


def test_gymnasium_makes_them() -> None:
    envs: Any = gym.make_vec("PRF/KobianFace-v0", 6, expression="surprise", render_mode="rgb_array", render_size=(40, 60))
    assert type(envs) is KobianFaceVectorEnv
    assert (envs.num_envs, envs.render_mode, len(envs.action_names)) == (6, "rgb_array", 13)
    observation_space, action_space = (getattr(envs, name) for name in ("observation_space", "action_space"))
    assert observation_space == gym.spaces.Box(0, 255, (6, 84, 84), np.uint8)
    assert action_space == gym.spaces.MultiDiscrete([13] * 6)
    observations, infos = envs.reset(seed=0)
    assert observations in observation_space and infos == {}
    frames = envs.render()
    assert isinstance(frames, tuple)
    assert [np.shape(frame) for frame in frames] == [(40, 60, 3)] * 6
    assert envs.spec is not None
    again = gym.make_vec(envs.spec)
    assert_equal(again.reset(seed=0), (observations, infos))
    assert isinstance(gym.make_vec("PRF/FlappyBird-v0"), FlappyBirdVectorEnv)


def test_frames_are_those_of_each_environment() -> None:
    native, single = pair("PRF/KobianFace-v0", AutoresetMode.NEXT_STEP, 3, render_mode="rgb_array", render_size=100)
    for envs in (native, single):
        envs.reset(seed=0)
        envs.step(np.array([1, 7, 11]))
    assert_equal(native.render(), single.render())


def test_seeds_are_those_of_the_environments() -> None:
    both: Any = pair("PRF/FlappyBird-v0", AutoresetMode.NEXT_STEP, 3)
    for envs in both:
        envs.reset(seed=20)
        assert envs.np_random_seed == (20, 21, 22)
    states = [[generator.bit_generator.state for generator in envs.np_random] for envs in both]
    assert states[0] == states[1]


def test_results_belong_to_the_caller() -> None:
    envs = BreakoutVectorEnv(num_envs=3, reward="variable", state="mirror", max_episode_steps=3)
    kept: list[Any] = [envs.reset(seed=1)]
    kept += [envs.step(np.ones(3, np.int64)) for _ in range(9)]
    copies = copy.deepcopy(kept)
    for result in [envs.step(np.zeros(3, np.int64)) for _ in range(3)]:
        for array in [*result[:4], *result[4].values()]:
            assert array.flags.writeable
            array[...] = 1
    assert_equal(kept, copies)


@pytest.mark.parametrize("threads", [2, 3, 64])
@pytest.mark.parametrize(("preset", "goal"), [("breakout-vrf", None), ("breakout", "breakout"), ("kobian-happy-kprf", "kobian-happy-kprf")])
def test_results_do_not_depend_on_threads(preset: str, goal: str | None, threads: int) -> None:
    count = 37
    results: list[list[NDArray[Any]]] = []
    for number in (1, threads):
        tasks = Tasks(
            preset, num_envs=count, goal=prf.preset_goal(goal) if goal else None, max_episode_steps=8, threads=number
        )
        observations = np.empty((count, 84, 84), np.uint8)
        numbers, flags = np.empty((2, count)), np.empty((2, count), np.bool_)
        seeds = np.arange(count, dtype=np.uint64)
        tasks.reset(np.ones(count, np.bool_), seeds, observations)
        played: list[NDArray[Any]] = [observations.copy()]
        restart: NDArray[np.bool_] = np.zeros(count, np.bool_)
        for step in range(30):
            actions = (np.arange(count) * (step + 2)) % len(tasks.actions)
            ends = tasks.step(actions, restart, seeds, observations, numbers[0], numbers[1], flags[0], flags[1])
            restart = flags[0] | flags[1]
            assert ends == restart.sum()
            played += [observations.copy(), numbers.copy(), flags.copy()]
        results.append(played)
    assert_equal(results[0], results[1])


@pytest.mark.parametrize("threads", [2, 1024])
def test_threads_may_be_limited(threads: int) -> None:
    made: list[Any] = [gym.make_vec("PRF/KobianFace-v0", 9, threads=count) for count in (1, threads)]
    one, many = made
    again = pickle.loads(pickle.dumps(one))
    assert [envs._tasks.__getnewargs_ex__()[1]["threads"] for envs in (one, many, again)] == [1, threads, 1]
    assert_equal(one.reset(seed=3), many.reset(seed=3))
    for actions in actions_of(one, 12):
        assert_equal(one.step(actions), many.step(actions))


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("way", ["pickle", "deepcopy"])
def test_copies_go_on_in_the_same_way(mode: AutoresetMode, way: str) -> None:
    envs = gym.make_vec("PRF/KobianFace-v0", 4, autoreset_mode=mode)
    envs.reset(seed=2)
    actions = actions_of(envs, 40)
    # Stopped where the next episodes are still to begin, and in the middle of one.
    for begin, end in [(0, 10), (10, 23), (23, 40)]:
        copied: Envs = copy.deepcopy(envs) if way == "deepcopy" else pickle.loads(pickle.dumps(envs))
        for step in actions[begin:end]:
            got, expected = copied.step(step), envs.step(step)
            assert_equal(got, expected)
            assert_equal(go_on(copied, got, mode), go_on(envs, expected, mode))


def test_steps_before_a_reset_and_after_closing_are_refused() -> None:
    envs = BreakoutVectorEnv(num_envs=3, render_mode="rgb_array")
    actions = np.zeros(3, np.int64)
    with pytest.raises(ResetNeeded, match="breakout has no episode yet: expected a reset"):
        envs.step(actions)
    with pytest.raises(ResetNeeded, match="render: got no episode yet, expected a reset before it"):
        envs.render()
    envs.reset(options={"reset_mask": np.array([True, True, False])})
    with pytest.raises(ResetNeeded, match="render: got no episode yet"):
        envs.render()
    with pytest.raises(ResetNeeded, match="breakout has no episode yet: expected a reset"):
        envs.step(actions)
    envs.reset()
    envs.step(actions)
    envs.close()
    envs.close()
    for call in (envs.reset, lambda: envs.step(actions), envs.render):
        with pytest.raises(ClosedEnvironmentError, match="closed"):
            call()


def test_without_autoreset_an_episode_that_is_over_has_to_be_reset() -> None:
    envs = KobianFaceVectorEnv(num_envs=2, max_episode_steps=1, autoreset_mode="Disabled")
    envs.reset()
    actions = np.ones(2, np.int64)
    envs.step(actions)
    envs.reset(options={"reset_mask": np.array([True, False])})
    with pytest.raises(ResetNeeded, match="the episode of kobian-happy is over: expected a reset"):
        envs.step(actions)
    envs.reset(options={"reset_mask": np.array([False, True])})
    envs.step(actions)


@pytest.mark.parametrize(
    ("actions", "error", "message"),
    [
        (np.array([0, 3, 0]), InvalidAction, r"actions\[1\]: got 3, expected 0 to 2"),
        (np.array([0, 0, -1]), InvalidAction, r"actions\[2\]: got -1, expected 0 to 2"),
        (np.array([2**63, 0, 0], np.uint64), InvalidAction, r"actions\[0\]: got 9223372036854775808, expected 0 to 2"),
        (np.zeros(3), TypeError, "actions: got an array of float64, expected 3 integers"),
        (np.full(3, np.nan), TypeError, "actions: got an array of float64, expected 3 integers"),
        (np.zeros(3, np.bool_), TypeError, "actions: got an array of bool, expected 3 integers"),
        (np.array(["a"] * 3), TypeError, "actions: got an array of <U1, expected 3 integers"),
        (np.zeros(2, np.int64), ValueError, r"actions: got shape \(2,\), expected 3 integers"),
        (np.zeros((3, 1), np.int64), ValueError, r"actions: got shape \(3, 1\), expected 3 integers"),
        (0, ValueError, r"actions: got shape \(\), expected 3 integers"),
        (None, ValueError, r"actions: got shape \(\), expected 3 integers"),
    ],
)
def test_wrong_actions_are_refused_and_nothing_is_played(actions: Any, error: type[Exception], message: str) -> None:
    envs, other = (BreakoutVectorEnv(num_envs=3) for _ in range(2))
    for each in (envs, other):
        each.reset(seed=1)
    with pytest.raises(error, match=message):
        envs.step(actions)
    good = np.array([0, 1, 2])
    assert_equal(envs.step(good), other.step(good))


@pytest.mark.parametrize("wrong", [np.array([0, 0, 3]), np.array([0, 0, 2**63], np.uint64)])
def test_a_refused_action_does_not_change_the_episodes_that_follow(wrong: Any) -> None:
    envs, other = (FlappyBirdVectorEnv(num_envs=3, max_episode_steps=2, state="mirror") for _ in range(2))
    actions = np.zeros(3, np.int64)
    for each in (envs, other):
        each.reset(seed=1)
        each.reset(options={"reset_mask": np.array([True, True, False])})
        each.step(actions)
        each.reset(options={"reset_mask": np.array([False, False, True])})
        each.step(actions)  # the first two are over
    with pytest.raises(InvalidAction, match=rf"actions\[2\]: got {wrong[2]}, expected 0 to 1"):
        envs.step(wrong)
    # Where an episode begins, the action is ignored.
    ignored = np.array([9, 2**63, 0], np.uint64)
    assert_equal(envs.step(ignored), other.step(actions))


def test_a_refused_seed_does_not_change_the_episodes_that_follow() -> None:
    envs, other = (FlappyBirdVectorEnv(num_envs=2, state="mirror") for _ in range(2))
    for each in (envs, other):
        each.reset(seed=1)
    for seeds in ([7, -1], [7, 1.5]):
        wrong: Any = seeds
        with pytest.raises(gym.error.Error, match="[Ss]eed"):
            envs.reset(seed=wrong)
    assert envs.np_random_seed == other.np_random_seed
    assert_equal(envs.reset(), other.reset())


@pytest.mark.parametrize("actions", [np.array([2, 1, 0], np.uint8), [2, 1, 0], (2, 1, 0), np.array([0, 1, 2])[::-1], np.array([2, 9, 1, 9, 0])[::2]])
def test_actions_may_be_any_integers(actions: Any) -> None:
    envs, other = (BreakoutVectorEnv(num_envs=3) for _ in range(2))
    for each in (envs, other):
        each.reset(seed=1)
    assert_equal(envs.step(actions), other.step(np.array([2, 1, 0])))


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"num_envs": 0}, ValueError, "num_envs: got 0, expected 1 to 4096"),
        ({"num_envs": 4097}, ValueError, "num_envs: got 4097, expected 1 to 4096"),
        ({"num_envs": -1}, ValueError, "num_envs: got -1, expected an int of at least 1"),
        ({"num_envs": 2.0}, TypeError, "num_envs: got float, expected an int"),
        ({"autoreset_mode": "Later"}, ValueError, "autoreset_mode: got 'Later', expected one of 'NextStep', 'SameStep'"),
        ({"render_mode": "human"}, ValueError, "render_mode: got 'human', expected one of 'rgb_array'"),
        ({"threads": 0}, ValueError, "threads: got 0, expected 1 to 1024"),
        ({"threads": 1025}, ValueError, "threads: got 1025, expected 1 to 1024"),
        ({"threads": 2.0}, TypeError, "threads: got float, expected an int"),
        ({"render_size": -3}, ValueError, "render_size: got -3, expected"),
        (
            {"num_envs": 4096, "goal": prf.DirectGoal(np.ones((84, 84), np.uint8), cell_px=1, orientations=36)},
            ValueError,
            "num_envs: got 4096, whose HOGs could have .* features, expected at most 268435456: take fewer environments",
        ),
    ],
)
def test_options_out_of_range_are_refused(options: dict[str, Any], error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        BreakoutVectorEnv(**options)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"seed": [1, 2]}, ValueError, "seed: got 2 of them, expected one for each of 3 environments"),
        ({"seed": 1.5}, TypeError, "seed: got float, expected an int, a sequence of them or None"),
        ({"seed": -2}, gym.error.Error, "[Ss]eed"),
        ({"options": {"reset_mask": [True] * 3}}, TypeError, "reset_mask: got list, expected an array of 3 bools"),
        ({"options": {"reset_mask": np.ones(3)}}, TypeError, "reset_mask: got an array of float64, expected"),
        ({"options": {"reset_mask": np.ones(2, np.bool_)}}, ValueError, r"reset_mask: got shape \(2,\), expected"),
        ({"options": {"reset_mask": np.zeros(3, np.bool_)}}, ValueError, "reset_mask: got no True, expected at least one"),
    ],
)
def test_wrong_resets_are_refused(arguments: dict[str, Any], error: type[Exception], message: str) -> None:
    envs = BreakoutVectorEnv(num_envs=3)
    with pytest.raises(error, match=message):
        envs.reset(**arguments)


def test_many_environments_are_stepped() -> None:
    envs = BreakoutVectorEnv(num_envs=4096, reward="variable", state="mirror")
    one = gym.make_vec("PRF/Breakout-v0", 1, reward="variable", state="mirror")
    observations, _ = envs.reset(seed=0)
    np.testing.assert_array_equal(observations[4095], one.reset(seed=4095)[0][0])
    for action in [1, 1, 2, 2]:
        observations, rewards, *_ = envs.step(np.full(4096, action))
        np.testing.assert_array_equal(observations[4095], one.step(np.array([action]))[0][0])
        assert rewards.shape == (4096,)
