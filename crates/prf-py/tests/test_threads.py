import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from pictures import natural

import prf


def test_threads_get_what_one_thread_gets() -> None:
    goal = natural(84, 84)
    frames = [natural(60 + seed, 90 - seed, seed) for seed in range(12)]
    expected = [(prf.reward(goal, frame), prf.hog(frame, cell_px=4, block_cells=2)) for frame in frames]
    with ThreadPoolExecutor(8) as pool:
        for _ in range(5):
            rewards = pool.map(lambda frame: prf.reward(goal, frame), frames)
            features = pool.map(lambda frame: prf.hog(frame, cell_px=4, block_cells=2), frames)
            for (reward, hog), got_reward, got_hog in zip(expected, rewards, features, strict=True):
                assert got_reward == reward
                np.testing.assert_array_equal(got_hog, hog)


@pytest.mark.parametrize("name", ["hog", "reward", "distance"])
def test_other_threads_run_meanwhile(name: str) -> None:
    """With so long a switch interval, only who lets go of the GIL lets another thread run."""
    image = natural(512, 512)
    arguments = (image,) if name == "hog" else (image, image)
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
        for _ in range(200):
            getattr(prf, name)(*arguments)
            if ran:
                break
        assert ran
    finally:
        sys.setswitchinterval(interval)
    thread.join()
