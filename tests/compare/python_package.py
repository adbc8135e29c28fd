"""The measurements of `cargo xtask compare python`: the package as it is called from Python, beside others.

    python python_package.py FOLDER

FOLDER holds cases.json and the pictures, as for perception_worker.py. Both sides of a row run in this one process and one
thread, in turns, A B B A …; only the ratios of neighbours in time count. Says in one line of JSON the versions, then one
for each row: group, title, peer, ours_ns, theirs_ns (times of a call, a list with one for each round) and the target.
"""

import gc
import json
import platform
import sys
import time
from importlib.metadata import version
from pathlib import Path

import ale_py
import cv2
import envpool
import flappy_bird_gymnasium  # noqa: F401: its import registers FlappyBird-v0
import gymnasium as gym
import numpy as np

import prf
from peers import PEERS
from perception_worker import pictures, say

TURN_NS = 20e6  # what a turn of the slower side takes at least


def main():
    folder = Path(sys.argv[1])
    cv2.setNumThreads(1)
    cv2.ocl.setUseOpenCL(False)
    ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
    gc.disable()  # as timeit does
    say({"versions": versions()})
    for group in (rewards(folder), worlds(), vectors()):
        for row in group:
            say(row)


def versions():
    names = {"Gymnasium": "gymnasium", "ALE": "ale-py", "EnvPool": "envpool", "flappy-bird-gymnasium": "flappy-bird-gymnasium"}
    found = {title: version(name) for title, name in names.items()}
    return {"prf-py": prf.__version__, "Python": platform.python_version(), "NumPy": np.__version__, "OpenCV": cv2.__version__, **found}


def in_turns(group, title, peer, ours, theirs, target, rounds=21):
    """Times `ours` and `theirs`, each a function of how many calls to make that returns how many it made."""
    sides = [ours, theirs]
    calls = [max(1, int(TURN_NS / per_call(side))) for side in sides]
    times = [[], []]
    for i in range(rounds):
        for side in (0, 1) if i % 2 == 0 else (1, 0):
            times[side].append(timed(sides[side], calls[side]))
    return {"group": group, "title": title, "peer": peer, "ours_ns": times[0], "theirs_ns": times[1], "target": target}


def timed(side, calls):
    start = time.perf_counter_ns()
    made = side(calls)
    return (time.perf_counter_ns() - start) / made


def per_call(side):
    """Nanoseconds of a call, which may make several steps."""
    made = side(2) / 2  # memory and caches are those of a long run
    return min(timed(side, 3) for _ in range(3)) * made


def rewards(folder):
    """Whole rewards as `goal.reward(frame)`: beside the same in Rust without the call, and beside OpenCV from Python."""
    for case in json.loads((folder / "cases.json").read_text()):
        if case["work"] != "reward":
            continue
        frames = pictures(folder, case["frames"])
        goal = goal_of(case, pictures(folder, case["goal"])[0])
        height, width = frames[0].shape
        words = f"{case['descriptor']}, {width}×{height}, {case['name'].split('-')[1]}, blocks of {case['hog']['block_cells']}"
        stacked, separate = np.stack(frames), list(frames)

        def one_by_one(calls, goal=goal, frames=separate):
            for _ in range(calls):
                goal.reset()
                for frame in frames:
                    goal.reward(frame)
            return calls * len(frames)

        def in_rust(calls, goal=goal, frames=stacked):
            for _ in range(calls):
                goal.reset()
                goal.rewards(frames, threads=1)
            return calls * len(frames)

        job = PEERS["opencv", "reward"](case, lambda key, case=case: pictures(folder, case[key])[0])

        def by_opencv(calls, job=job, frames=separate):
            for _ in range(calls):
                for frame in frames:
                    job.call(frame)
            return calls * len(frames)

        if (height, width) == (84, 84):
            # A frame in a call for all of them costs what it costs in Rust
            yield in_turns("Call", words, "Rust", one_by_one, in_rust, None)
        yield in_turns("Reward", words, "OpenCV", one_by_one, by_opencv, 5.0)


def goal_of(case, picture):
    hog, motion = case["hog"], case["motion"]
    cell = {"cell_px": hog["cell"]["px"]} if "px" in hog["cell"] else {"cell": hog["cell"]["fraction"]}
    options = {"block_cells": hog["block_cells"], "norm": hog["norm"], **cell}
    match case["descriptor"]:
        case "direct":
            return prf.DirectGoal(picture, **options)
        case "window":
            return prf.WindowGoal(picture, method="ccorr-normed", **options)
        case _:
            duration = {"duration": motion["delta"]["duration"]}
            schedule = {key: motion[key] for key in ("threshold", "tau_start", "tau_step")}
            return prf.MotionGoal(picture, **schedule, **duration, **options)


def worlds():
    """A step and its picture."""
    ours = gym.make("PRF/FlappyBird-v0", reward="variable", state="mirror", render_mode="rgb_array", render_size=(512, 288))
    theirs = gym.make("FlappyBird-v0", render_mode="rgb_array", use_lidar=False)
    group = "Worlds"
    title = "Flappy Bird, `step` and `render` to RGB, 288×512, a single environment"
    yield in_turns(group, title, "flappy-bird-gymnasium", rendered(ours), rendered(theirs), None)
    title = "Flappy Bird, a drawn frame, 64 in a vector (84×84), beside one rendered (288×512)"
    yield in_turns(group, title, "flappy-bird-gymnasium", vector("PRF/FlappyBird-v0"), rendered(theirs), 200.0)
    title = "Breakout, a drawn frame, 64 in a vector (84×84), beside `act` and `getScreenGrayscale` (160×210)"
    yield in_turns(group, title, "ALE", vector("PRF/Breakout-v0"), ale(), 20.0)
    title = "Breakout, 64 in a vector each, frame skip 1, one thread"
    yield in_turns(group, title, "EnvPool", vector("PRF/Breakout-v0"), pool(), 20.0)


def rendered(env):
    env.reset(seed=1)

    def steps(calls):
        for i in range(calls):
            _, _, terminated, truncated, _ = env.step(int(i % 17 == 0))
            env.render()
            if terminated or truncated:
                env.reset()
        return calls

    return steps


def vector(name, num_envs=64, **options):
    envs = gym.make_vec(name, num_envs=num_envs, threads=1, **{"reward": "variable", "state": "mirror", **options})
    return stepped(envs)


def stepped(envs):
    envs.reset(seed=1)
    rng = np.random.default_rng(1)
    actions = rng.integers(envs.single_action_space.n, size=(64, envs.num_envs))

    def steps(calls):
        for i in range(calls):
            envs.step(actions[i % 64])
        return calls * envs.num_envs

    return steps


def ale():
    game = ale_py.ALEInterface()
    game.setInt("random_seed", 1)
    game.loadROM(ale_py.roms.get_rom_path("breakout"))
    actions, screen = game.getMinimalActionSet(), np.empty((210, 160), np.uint8)

    def steps(calls):
        for i in range(calls):
            game.act(actions[i % len(actions)])
            game.getScreenGrayscale(screen)
            if game.game_over():
                game.reset_game()
        return calls

    return steps


def pool(num_envs=64):
    envs = envpool.make("Breakout-v5", "gymnasium", num_envs=num_envs, num_threads=1, frame_skip=1, stack_num=1)
    envs.reset()
    actions = np.random.default_rng(1).integers(4, size=(64, num_envs)).astype(np.int32)

    def steps(calls):
        for i in range(calls):
            envs.step(actions[i % 64])
        return calls * num_envs

    return steps


def vectors():
    """The native vector environments beside as many single ones."""
    for name in ("PRF/Breakout-v0", "PRF/FlappyBird-v0", "PRF/KobianFace-v0"):
        for reward, state, target in (("variable", "mirror", 20.0), ("perceptual", None, None)):
            options = {"reward": reward} | ({"state": state} if state else {})
            singles = gym.make_vec(name, num_envs=64, vectorization_mode="sync", **options)
            title = f"{name}, 64 environments, {reward} reward"
            yield in_turns("Vector", title, "SyncVectorEnv", vector(name, **options), stepped(singles), target)


if __name__ == "__main__":
    main()
