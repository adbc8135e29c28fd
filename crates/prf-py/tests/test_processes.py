"""Processes that are forked or spawned, also while threads compute."""

import multiprocessing
import subprocess
import sys
import textwrap

import numpy as np
import pytest
from pictures import moving

import prf

FRAMES = moving(12, 84, 84)


def run(script: str) -> None:
    """Runs a script with a process of its own, which may not take long."""
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(script)], timeout=120, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_process_may_fork_while_threads_compute() -> None:
    run(
        """
        import os, threading, time, warnings
        import numpy as np
        import prf

        warnings.simplefilter("ignore")  # Python itself advises against it
        rng = np.random.default_rng(0)
        frames = rng.integers(0, 256, (40, 128, 128), np.uint8)
        direct, window, motion = prf.DirectGoal(frames[0]), prf.WindowGoal(frames[0, :20, :30]), prf.MotionGoal(frames)
        expected = prf.DirectGoal(frames[0]).rewards(frames, threads=1)
        stop = threading.Event()

        def compute(call):
            while not stop.is_set():
                try:
                    call()
                except RuntimeError:  # the motion goal is being copied
                    pass

        calls = [
            lambda: direct.rewards(frames), lambda: window.rewards(frames[:4]), lambda: motion.rewards(frames),
            lambda: prf.hog_batch(frames), lambda: direct.reward(frames[1]), lambda: prf.reward(frames[0], frames[1]),
        ]
        threads = [threading.Thread(target=compute, args=(call,)) for call in calls]
        for thread in threads:
            thread.start()
        for _ in range(20):
            time.sleep(0.01)
            child = os.fork()
            if child == 0:
                ok = (direct.rewards(frames) == expected).all()
                ok &= direct.reward(frames[1]) == expected[1]
                ok &= (prf.reward_batch(frames[0], frames, threads=3) == expected).all()
                ok &= prf.hog_batch(frames).shape[0] == 40 and window.score(frames[0]).reward == 1
                ok &= prf.MotionGoal(frames).rewards(frames)[-1] == 1
                try:
                    motion.reset()
                    motion.reward(frames[0])
                except RuntimeError:  # another thread was just at it, which is not in this process
                    pass
                os._exit(0 if ok else 1)
            until = time.monotonic() + 60
            while True:
                done, status = os.waitpid(child, os.WNOHANG)
                if done:
                    assert status == 0, status
                    break
                if time.monotonic() > until:
                    os.kill(child, 9)
                    raise SystemExit("the child hangs")
                time.sleep(0.005)
        stop.set()
        for thread in threads:
            thread.join()
        """
    )


def rest_of_episode(goal: prf.Goal) -> list[float]:
    return [goal.reward(frame) for frame in FRAMES[5:]]


@pytest.mark.parametrize(
    "goal",
    [
        prf.DirectGoal(FRAMES[3]),
        prf.WindowGoal(FRAMES[3, :30, 20:60]),
        prf.MotionGoal(FRAMES, skip_still=True),
    ],
)
def test_a_spawned_process_goes_on_with_the_episode(goal: prf.Goal) -> None:
    goal.reset(FRAMES[0])
    goal.rewards(FRAMES[1:5])
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        done = pool.map_async(rest_of_episode, [goal, goal])
        results = done.get(timeout=120)
    expected = rest_of_episode(goal)
    assert results == [expected, expected]


def test_a_pool_of_processes_scores_frames() -> None:
    goal = prf.DirectGoal(FRAMES[0])
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        got = pool.map_async(goal.reward, FRAMES).get(timeout=120)
    np.testing.assert_array_equal(np.array(got, np.float32), goal.rewards(FRAMES))


@pytest.mark.parametrize(
    "call",
    [
        "prf.DirectGoal(goal).rewards(frames, threads=1)",
        "prf.MotionGoal(goal).rewards(frames)",
        "prf.reward_batch(goal, frames, threads=1)",
    ],
)
def test_more_frames_than_memory_do_not_end_the_process(call: str) -> None:
    run(
        f"""
        import resource
        import numpy as np
        import prf

        frames, goal = np.zeros((2**27, 1, 1), np.uint8), np.full((9, 9), 7, np.uint8)
        in_use = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (in_use + 2**28, in_use + 2**28))
        try:
            {call}
        except MemoryError:
            pass
        else:
            raise SystemExit("there was room for 512 MiB of rewards")
        """
    )
