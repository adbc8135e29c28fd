"""The peers' side of `cargo xtask compare training`: PyTorch's update and Stable-Baselines3's DQN.

    python training_worker.py CONFIG.toml

CONFIG is what crates/prf-dqn/examples/training_worker trains. Says its versions in one line of JSON, then answers each line
`time CASE PEER TURNS` with the calls made and their nanoseconds:

    bare    torch-SETTINGS   an update from fixed tensors; SETTINGS are names of SETTINGS below, joined by +
    train   sb3              a step of the environment in a run that goes on from call to call
    update  sb3              an update in the same run, and all that it takes to get there
"""

import json
import os
import platform
import sys
import time
import tomllib
from importlib.metadata import version

import gymnasium as gym
import stable_baselines3 as sb3
import torch
from gymnasium.wrappers import ReshapeObservation
from torch import nn
from torch.nn import functional

import prf

SETTINGS = {"plain", "fused", "channels_last", "bf16"}


def main():
    with open(sys.argv[1], "rb") as file:
        config = tomllib.load(file)
    threads = config["train"]["threads"] or len(os.sched_getaffinity(0))
    torch.set_num_threads(threads)
    names = {"PyTorch": "torch", "Stable-Baselines3": "stable-baselines3", "Gymnasium": "gymnasium"}
    found = {title: version(name) for title, name in names.items()}
    say({"versions": {**found, "prf-py": prf.__version__, "Python": platform.python_version()}})
    cases = {}
    for line in sys.stdin:
        _, name, peer, turns = line.split()
        if (name, peer) not in cases:
            cases[name, peer] = Bare(config, peer) if name == "bare" else Run(config, name)
        say(cases[name, peer].turns(int(turns)))


class Bare:
    """The update of Stable-Baselines3's DQN without anything around it, as fast as PyTorch's own switches make it."""

    def __init__(self, config, peer):
        settings = set(peer.removeprefix("torch-").split("+"))
        assert settings <= SETTINGS, f"{settings} are not among {SETTINGS}"
        train = config["train"]
        size, self.gamma, self.bf16 = train["batch_size"], train["gamma"], "bf16" in settings
        memory = torch.channels_last if "channels_last" in settings else torch.contiguous_format
        torch.manual_seed(0)
        self.online, self.target = (network().to(memory_format=memory) for _ in range(2))
        # Adam's own choice among its unfused forms is `plain`.
        fused = True if "fused" in settings else None
        self.optimizer = torch.optim.Adam(self.online.parameters(), lr=train["learning_rate"], fused=fused)
        self.states, self.next_states = (torch.rand(size, 1, 84, 84).to(memory_format=memory) for _ in range(2))
        self.actions = torch.arange(size).remainder(3).unsqueeze(1)
        self.rewards = torch.full((size,), 0.5)

    def update(self):
        with torch.autocast("cpu", dtype=torch.bfloat16, enabled=self.bf16):
            with torch.no_grad():
                targets = self.rewards + self.gamma * self.target(self.next_states).float().amax(1)
            values = self.online(self.states).float().gather(1, self.actions).squeeze(1)
            loss = functional.smooth_l1_loss(values, targets)
        self.optimizer.zero_grad()
        loss.backward()
        self.optimizer.step()
        return loss.item()

    def turns(self, turns):
        start = time.perf_counter_ns()
        for _ in range(turns):
            self.update()
        return {"calls": turns, "ns": time.perf_counter_ns() - start}


def network():
    return nn.Sequential(
        *(nn.Conv2d(1, 32, 8, 4), nn.ReLU(), nn.Conv2d(32, 64, 4, 2), nn.ReLU(), nn.Conv2d(64, 64, 3, 1), nn.ReLU()),
        *(nn.Flatten(), nn.Linear(3136, 512), nn.ReLU(), nn.Linear(512, 3)),
    )


class Run:
    """Stable-Baselines3's DQN, already at the point where it learns."""

    def __init__(self, config, name):
        train, epsilon = config["train"], config["train"]["epsilon"]
        self.steps_per_turn = train["steps_per_update"] if name == "update" else 1
        env = gym.make("PRF/Breakout-v0", state=config["state"]["kind"], max_episode_steps=config["env"]["limit_steps"])
        # Its network for pictures wants an axis for colours.
        env = ReshapeObservation(env, (84, 84, 1))
        self.model = sb3.DQN(
            "CnnPolicy",
            env,
            learning_rate=train["learning_rate"],
            buffer_size=train["replay_steps"],
            learning_starts=train["learning_starts"],
            batch_size=train["batch_size"],
            gamma=train["gamma"],
            train_freq=train["steps_per_update"],
            target_update_interval=train["target_every_updates"] * train["steps_per_update"],
            exploration_initial_eps=epsilon["start"],
            exploration_final_eps=epsilon["end"],
            exploration_fraction=0.01,
            seed=config["seed"],
        )
        self.model.learn(train["learning_starts"] + 32 * train["steps_per_update"])

    def turns(self, turns):
        steps = turns * self.steps_per_turn
        before = self.model.num_timesteps
        start = time.perf_counter_ns()
        self.model.learn(steps, reset_num_timesteps=False)
        took = time.perf_counter_ns() - start
        return {"calls": (self.model.num_timesteps - before) // self.steps_per_turn, "ns": took}


def say(line):
    print(json.dumps(line), flush=True)


if __name__ == "__main__":
    main()
