"""What environments show."""

import copy
import sys
import warnings
from typing import Any

import gymnasium as gym
import numpy as np
import pygame
import pytest
from gymnasium.error import DependencyNotInstalled
from gymnasium.wrappers import AddRenderObservation

from prf.envs import BreakoutEnv, FlappyBirdEnv, KobianFaceEnv

CLASSES: list[Any] = [BreakoutEnv, FlappyBirdEnv, KobianFaceEnv]


def surface() -> pygame.Surface:
    shown = pygame.display.get_surface()
    assert shown is not None
    return shown


def frame_of(env: Any) -> Any:
    frame: Any = env.render()
    assert type(frame) is np.ndarray and frame.dtype == np.uint8 and frame.shape[2] == 3
    return frame


@pytest.mark.parametrize("cls", CLASSES)
def test_frames_are_what_the_agent_sees_in_grey(cls: Any) -> None:
    env = cls(state="mirror", render_mode="rgb_array", render_size=84)
    observation, _ = env.reset(seed=1)
    for action in (1, 0, 1):
        np.testing.assert_array_equal(frame_of(env), np.repeat(observation[..., np.newaxis], 3, axis=2))
        observation, *_ = env.step(action)


@pytest.mark.parametrize("cls", [BreakoutEnv, FlappyBirdEnv])
def test_edges_are_sharp_at_multiples_of_the_size(cls: Any) -> None:
    env = cls(state="mirror", render_mode="rgb_array", render_size=(168, 252))
    env.reset(seed=1)
    observation, *_ = env.step(1)
    np.testing.assert_array_equal(frame_of(env)[..., 0], observation.repeat(2, axis=0).repeat(3, axis=1))


def test_worlds_are_drawn_anew_at_each_size() -> None:
    env = KobianFaceEnv(state="mirror", render_mode="rgb_array", render_size=336)
    observation, _ = env.reset(seed=1)
    frame = frame_of(env)[..., 0].astype(np.float64)
    means = frame.reshape(84, 4, 84, 4).mean(axis=(1, 3))
    assert np.abs(means - observation).mean() < 0.5  # edges differ a little
    assert not np.array_equal(frame, observation.repeat(4, axis=0).repeat(4, axis=1))


def test_the_size_may_be_anything() -> None:
    for size, shape in [(336, (336, 336, 3)), (1, (1, 1, 3)), ((50, 121), (50, 121, 3))]:
        env = BreakoutEnv(render_mode="rgb_array", render_size=size)  # type: ignore[arg-type]
        env.reset(seed=1)
        assert frame_of(env).shape == shape
    env = BreakoutEnv(render_mode="rgb_array")
    env.reset()
    assert frame_of(env).shape == (336, 336, 3)


def test_frames_belong_to_the_caller() -> None:
    env = BreakoutEnv(render_mode="rgb_array")
    env.reset(seed=1)
    first = frame_of(env)
    kept = first.copy()
    env.step(1)
    frame_of(env)[:] = 9
    np.testing.assert_array_equal(first, kept)
    assert first.flags.owndata


def test_gymnasium_collects_and_observes_frames() -> None:
    env = gym.make("PRF/Breakout-v0", render_mode="rgb_array_list", render_size=20)
    env.reset(seed=1)
    env.step(1)
    frames: Any = env.render()
    assert [frame.shape for frame in frames] == [(20, 20, 3)] * 2
    observed = AddRenderObservation(gym.make("PRF/FlappyBird-v0", render_mode="rgb_array", render_size=30))
    assert observed.reset(seed=1)[0].shape == (30, 30, 3)
    assert BreakoutEnv.metadata["render_modes"] == ["human", "rgb_array"]


def test_without_a_mode_nothing_is_shown() -> None:
    env = BreakoutEnv()
    env.reset()
    with pytest.warns(UserWarning, match="without a render mode: make the environment with render_mode='rgb_array'"):
        assert env.render() is None
    envs = gym.make_vec("PRF/Breakout-v0", 2)
    envs.reset()
    with pytest.warns(UserWarning, match="without a render mode"):
        assert envs.render() is None


@pytest.mark.parametrize("cls", CLASSES)
def test_a_window_shows_every_frame(cls: Any) -> None:
    env = cls(render_mode="human", render_size=(60, 90))
    twin = cls(render_mode="rgb_array", render_size=(60, 90))
    env.metadata = {**env.metadata, "render_fps": 1000}
    for action in (None, 1, 0):
        for each in (env, twin):
            each.reset(seed=2) if action is None else each.step(action)
        shown = pygame.surfarray.array3d(surface()).swapaxes(0, 1)
        np.testing.assert_array_equal(shown, frame_of(twin))
    assert env.render() is None
    assert pygame.display.get_caption()[0] == cls.__name__
    env.close()
    assert not pygame.display.get_init()
    env.close()


def test_a_second_window_takes_the_place_of_the_first() -> None:
    one, other = (BreakoutEnv(render_mode="human", render_size=side) for side in (40, 50))
    for env in (one, other):
        env.metadata = {**env.metadata, "render_fps": 1000}
        env.reset(seed=1)
    other.close()
    one.step(1)
    assert surface().get_size() == (40, 40)
    one.close()


def test_pygame_is_asked_for_where_it_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pygame", None)
    env = BreakoutEnv(render_mode="human")
    with pytest.raises(DependencyNotInstalled, match='pygame is not installed, run `pip install "prf-py\\[human\\]"`'):
        env.reset()
    quiet = BreakoutEnv(render_mode="rgb_array")
    quiet.reset()
    assert frame_of(quiet).max() == 255


def test_a_copy_opens_a_window_of_its_own() -> None:
    env = BreakoutEnv(render_mode="human", render_size=40)
    env.metadata = {**env.metadata, "render_fps": 1000}
    env.reset(seed=1)
    copied = copy.deepcopy(env)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        copied.step(1)
    assert surface().get_size() == (40, 40)
    copied.close()
    env.close()
