"""Presets are the configs, and environments play them as the Rust crate does, to the bit."""

import json
import zlib
from pathlib import Path
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from pictures import read, read_frames

import prf

REPOSITORY = Path(__file__).parents[3]
GOALS = REPOSITORY / "configs" / "goals"
EPISODES: list[dict[str, Any]] = json.loads((REPOSITORY / "tests/golden/rust/tasks.json").read_text())
PERCEPTUAL = ["breakout", "flappy", "kobian-happy-hprf", "kobian-happy-kprf", "kobian-surprise-hprf", "kobian-surprise-kprf"]


def make(preset: str) -> gym.Env[Any, Any]:
    """The environment of a preset."""
    world, _, source = preset.rpartition("-") if "-" in preset else (preset, "", "")
    id = {"breakout": "PRF/Breakout-v0", "flappy": "PRF/FlappyBird-v0"}.get(world, "PRF/KobianFace-v0")
    options: dict[str, Any] = {"expression": world.removeprefix("kobian-")} if "kobian" in world else {}
    if source == "vrf":
        options["reward"] = "variable"
    if source == "hprf":
        options["goal"] = prf.preset_goal(preset)
    return gym.make(id, **options)


@pytest.mark.parametrize("episode", EPISODES, ids=lambda episode: f"{episode['preset']}-{episode['seed']}")
def test_environments_play_the_episodes_of_rust(episode: dict[str, Any]) -> None:
    env = make(episode["preset"])
    env.reset(seed=episode["seed"])
    for step in episode["steps"]:
        observation, reward, terminated, truncated, info = env.step(step["action"])
        assert reward == np.float32(step["reward"])
        assert info == {"score": step["score"]}
        assert (terminated or truncated) is step["is_over"]
        assert zlib.crc32(observation.tobytes()) == step["observation"]


def test_every_config_is_played() -> None:
    configs = {path.stem for path in (REPOSITORY / "configs").glob("*.toml")}
    assert {episode["preset"] for episode in EPISODES} == configs
    assert configs == {*PERCEPTUAL, *(name for name in configs if name.endswith("-vrf"))}


@pytest.mark.parametrize(
    ("id", "options", "preset"),
    [
        ("PRF/Breakout-v0", {}, "breakout"),
        ("PRF/FlappyBird-v0", {}, "flappy"),
        ("PRF/KobianFace-v0", {}, "kobian-happy-kprf"),
        ("PRF/KobianFace-v0", {"expression": "surprise"}, "kobian-surprise-kprf"),
    ],
)
def test_rewards_are_those_of_the_goal_alone(id: str, options: dict[str, Any], preset: str) -> None:
    env = gym.make(id, state="mirror", **options)
    goal = prf.preset_goal(preset)
    env.action_space.seed(3)
    for seed in range(3):
        observation, _ = env.reset(seed=seed)
        goal.reset(observation)
        over = False
        while not over:
            observation, reward, terminated, truncated, _ = env.step(env.action_space.sample())
            assert reward == goal.reward(observation)
            over = terminated or truncated


def test_goals_are_those_of_the_files() -> None:
    assert isinstance(prf.preset_goal("breakout"), prf.DirectGoal)
    assert isinstance(prf.preset_goal("flappy"), prf.WindowGoal)
    np.testing.assert_array_equal(prf.preset_goal("breakout").goal, read(GOALS / "black.png"))
    np.testing.assert_array_equal(prf.preset_goal("flappy").goal, read(GOALS / "flappy.png"))
    for expression in ("happy", "surprise"):
        goal = prf.preset_goal(f"kobian-{expression}-kprf")
        assert isinstance(goal, prf.MotionGoal)
        frames = read_frames(GOALS / f"kobian-{expression}.gif")
        template = prf.motion_template(
            frames,
            threshold=goal.threshold,
            tau_start=goal.tau_start,
            tau_step=goal.tau_step,
            delta_divisor=goal.delta_divisor,
            skip_still=goal.skip_still,
        )
        np.testing.assert_array_equal(goal.goal, template)


def test_another_picture_keeps_the_settings() -> None:
    screen = read(GOALS / "flappy-screen.png")[20:50, 10:40]
    goal = prf.preset_goal("flappy", screen)
    assert isinstance(goal, prf.WindowGoal)
    np.testing.assert_array_equal(goal.goal, screen)
    own = prf.preset_goal("flappy")
    assert isinstance(own, prf.WindowGoal)
    assert (goal.method, goal.norm, goal.cell) == (own.method, own.norm, own.cell)
    from_file = prf.preset_goal("breakout", GOALS / "flappy-screen.png")
    np.testing.assert_array_equal(from_file.goal, read(GOALS / "flappy-screen.png"))


def test_other_names_are_refused() -> None:
    for name in ("pong", "breakout-vrf", ""):
        with pytest.raises(ValueError, match=f"name: got '{name}', expected one of 'breakout', 'flappy', 'kobian-happy-hprf'"):
            prf.preset_goal(name)
    with pytest.raises(FileNotFoundError):
        prf.preset_goal("flappy", "nowhere.png")
    wrong: Any = [1]
    with pytest.raises(TypeError, match="goal: got list, expected"):
        prf.preset_goal("flappy", wrong)
    with pytest.raises(TypeError):
        prf.preset_goal(wrong)
