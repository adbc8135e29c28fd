"""Any number of threads may call anything."""

import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from pictures import Bytes, moving, natural

import prf
from prf._native import Tasks

GOAL = natural(84, 84)
FRAMES = moving(12, 84, 84)
PART = FRAMES[6, 4:30, 26:44]


def test_threads_get_what_one_thread_gets() -> None:
    work: list[Callable[[Bytes], Any]] = [
        lambda frame: prf.reward(GOAL, frame),
        lambda frame: prf.hog(frame, cell_px=4, block_cells=2),
        lambda frame: prf.match_template(frame, PART),
        lambda frame: prf.crop_box(frame),
        lambda frame: prf.reward_batch(frame, FRAMES[:3], threads=2),
        lambda frame: prf.motion_template(FRAMES),
    ]
    expected = [[call(frame) for frame in FRAMES] for call in work]
    with ThreadPoolExecutor(8) as pool:
        for _ in range(5):
            for got, results in [
                (pool.map(call, FRAMES), want) for call, want in zip(work, expected, strict=True)
            ]:
                for one, other in zip(got, results, strict=True):
                    np.testing.assert_array_equal(one, other)


@pytest.mark.parametrize("make", [lambda: prf.DirectGoal(GOAL), lambda: prf.WindowGoal(PART)])
def test_direct_and_window_goals_may_be_shared(make: Callable[[], prf.Goal]) -> None:
    goal = make()
    expected = [goal.score(frame) for frame in FRAMES]
    rewards = goal.rewards(FRAMES)
    with ThreadPoolExecutor(8) as pool:
        for _ in range(10):
            many = [pool.submit(goal.rewards, FRAMES, threads=2) for _ in range(4)]
            assert list(pool.map(goal.score, FRAMES)) == expected
            for one in many:
                np.testing.assert_array_equal(one.result(), rewards)


def test_each_thread_may_have_a_copy_of_a_motion_goal() -> None:
    goal = prf.MotionGoal(FRAMES)
    expected = goal.copy().rewards(FRAMES)

    def episode(_: int) -> list[float]:
        own = goal.copy()
        return [own.reward(frame) for frame in FRAMES]

    with ThreadPoolExecutor(8) as pool:
        for got in pool.map(episode, range(20)):
            assert got == expected.tolist()


def calls(one: Callable[[], object]) -> dict[str, int]:
    """How often calls from many threads were done and refused."""
    count = {"done": 0, "refused": 0}
    lock = threading.Lock()
    start = threading.Barrier(6)

    def thread() -> None:
        start.wait()
        for _ in range(60):
            try:
                one()
                result = "done"
            except RuntimeError as error:
                assert "another thread is using" in str(error)
                result = "refused"
            with lock:
                count[result] += 1

    threads = [threading.Thread(target=thread) for _ in range(6)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert sum(count.values()) == 360
    return count


def test_a_shared_motion_goal_does_each_call_whole_or_refuses_it() -> None:
    goal, twin = prf.MotionGoal(FRAMES), prf.MotionGoal(FRAMES)
    large = natural(512, 512)
    done = calls(lambda: goal.reward(large))["done"]
    for _ in range(done):
        twin.reward(large)
    assert goal.__getstate__() == twin.__getstate__()


@pytest.mark.parametrize("make", [prf.MotionTemplate, prf.EmaState])
def test_a_shared_state_does_each_call_whole_or_refuses_it(make: Callable[[], Any]) -> None:
    shared, twin = make(), make()
    frames = [natural(256, 256), natural(256, 256, seed=2)]
    shared.update(frames[0])
    twin.update(frames[0])
    done = calls(lambda: shared.update(frames[1]))["done"]
    for _ in range(done):
        twin.update(frames[1])
    np.testing.assert_array_equal(shared.__getstate__(), twin.__getstate__())


def test_whoever_comes_while_another_thread_computes_is_refused() -> None:
    frames = moving(60, 512, 512)
    goal, stop = prf.MotionGoal(FRAMES), threading.Event()

    def compute() -> None:
        while not stop.is_set():
            with suppress(RuntimeError):
                goal.rewards(frames)

    thread = threading.Thread(target=compute)
    thread.start()
    calls: dict[str, Callable[[], object]] = {
        "reward": lambda: goal.reward(frames[0]),
        "reset": goal.reset,
        "copy": goal.copy,
        "explain": lambda: goal.explain(frames[0]),
    }
    until = time.monotonic() + 60
    while calls and time.monotonic() < until:
        for name, call in list(calls.items()):
            try:
                call()
            except RuntimeError as error:
                assert "got a call while another thread is using this object" in str(error)
                del calls[name]
    stop.set()
    thread.join()
    assert not calls
    goal.reset()
    assert goal.reward(FRAMES[0]) == prf.MotionGoal(FRAMES).reward(FRAMES[0])


LARGE = natural(512, 512)
STACK = np.stack([LARGE] * 2)
DIRECT, WINDOW, MOTION = prf.DirectGoal(GOAL), prf.WindowGoal(PART), prf.MotionGoal(FRAMES)
TEMPLATE, STATE = prf.MotionTemplate(), prf.EmaState()
KERNELS: dict[str, Callable[[], object]] = {
    "hog": lambda: prf.hog(LARGE),
    "hog_batch": lambda: prf.hog_batch(STACK),
    "crop_box": lambda: prf.crop_box(LARGE),
    "crop_box_batch": lambda: prf.crop_box_batch(STACK),
    "match_template": lambda: prf.match_template(LARGE, PART),
    "match_template_batch": lambda: prf.match_template_batch(STACK, PART),
    "motion_template": lambda: prf.motion_template(STACK),
    "reward": lambda: prf.reward(LARGE, LARGE),
    "distance": lambda: prf.distance(LARGE, LARGE),
    "reward_batch": lambda: prf.reward_batch(LARGE, STACK),
    "distance_batch": lambda: prf.distance_batch(LARGE, STACK),
    "DirectGoal.reward": lambda: DIRECT.reward(LARGE),
    "DirectGoal.rewards": lambda: DIRECT.rewards(STACK),
    "DirectGoal.explain": lambda: DIRECT.explain(LARGE),
    "WindowGoal.score": lambda: WINDOW.score(LARGE),
    "MotionGoal.reward": lambda: MOTION.reward(LARGE),
    "MotionGoal.rewards": lambda: MOTION.rewards(STACK),
    "MotionGoal.reset": lambda: MOTION.reset(LARGE),
    "DirectGoal": lambda: prf.DirectGoal(LARGE),
    "WindowGoal": lambda: prf.WindowGoal(LARGE),
    "MotionGoal": lambda: prf.MotionGoal(FRAMES),
    "Tasks": lambda: Tasks("breakout", num_envs=8, goal=DIRECT),
    "MotionTemplate": lambda: TEMPLATE.update(LARGE),
    "EmaState": lambda: STATE.update(LARGE),
}


@pytest.mark.parametrize("name", KERNELS)
def test_other_threads_run_meanwhile(name: str) -> None:
    """With so long a switch interval, only who lets go of the GIL lets another thread run."""
    gate = threading.Lock()
    ran: list[bool] = []

    def other() -> None:
        with gate:
            ran.append(True)

    gate.acquire()
    thread = threading.Thread(target=other)
    thread.start()
    interval = sys.getswitchinterval()
    try:
        sys.setswitchinterval(1000)
        gate.release()
        until = time.monotonic() + 60
        while not ran and time.monotonic() < until:
            KERNELS[name]()
        assert ran
    finally:
        sys.setswitchinterval(interval)
    thread.join()
