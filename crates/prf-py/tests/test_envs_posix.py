"""Environments beside threads, and in processes that are forked."""

import os
import signal
import threading
import warnings
from collections.abc import Generator
from contextlib import contextmanager, suppress
from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import data_equivalence

import prf
from prf._native import Tasks
from prf.envs import BreakoutEnv, FlappyBirdEnv, KobianFaceEnv

CLASSES: list[Any] = [BreakoutEnv, FlappyBirdEnv, KobianFaceEnv]


def test_environments_live_in_forked_processes() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of forking beside threads, which are not PRF's
        apart = gym.make_vec("PRF/Breakout-v0", 2, vectorization_mode="async", vector_kwargs={"context": "fork"})
    together = gym.make_vec("PRF/Breakout-v0", 2, vectorization_mode="sync")
    try:
        assert data_equivalence(apart.reset(seed=6), together.reset(seed=6), exact=True)
        for step in range(30):
            actions = np.array([step % 3, 0])
            assert data_equivalence(apart.step(actions), together.step(actions), exact=True)
    finally:
        apart.close()


@contextmanager
def stepping(tasks: Tasks, count: int) -> Generator[None, None, None]:
    """Steps these tasks in another thread meanwhile."""
    arrays: list[Any] = [np.empty((count, 84, 84), np.uint8), np.empty(count), np.empty(count)]
    arrays += [np.empty(count, np.bool_), np.empty(count, np.bool_)]
    seeds, restart = np.arange(count, dtype=np.uint64), np.ones(count, np.bool_)
    restart[::2] = False
    tasks.reset(np.ones(count, np.bool_), seeds, arrays[0])
    actions = np.zeros(count, np.int64)
    done = threading.Event()

    def run() -> None:
        while not done.is_set():
            with suppress(RuntimeError):
                tasks.step(actions, restart, seeds, *arrays)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        yield
    finally:
        done.set()
        thread.join()


def test_two_threads_can_not_use_an_environment_at_once() -> None:
    tasks = Tasks("kobian-happy-kprf", num_envs=128, goal=prf.preset_goal("kobian-happy-kprf"))
    message = "while another thread is using this object, expected one at a time"
    with stepping(tasks, 128), pytest.raises(RuntimeError, match=message):
        while True:
            tasks.__getstate__()
    tasks.__getstate__()


def test_a_fork_while_another_thread_steps_does_not_wait_forever() -> None:
    tasks = Tasks("kobian-happy-kprf", num_envs=128, goal=prf.preset_goal("kobian-happy-kprf"))
    with stepping(tasks, 128):
        for _ in range(10):
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", DeprecationWarning)
                child = os.fork()
            if child == 0:
                signal.alarm(20)  # ends the process if it waits
                status = 1
                try:
                    with suppress(RuntimeError):
                        tasks.__getstate__()
                    for cls in CLASSES:
                        env = cls()
                        env.reset(seed=1)
                        env.step(1)
                    status = 0
                finally:
                    os._exit(status)
            assert os.waitpid(child, 0)[1] == 0
