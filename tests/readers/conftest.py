"""Runs of `prf` for other programs to read. PRF names the program; `cargo xtask test` sets it."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest
from PIL import Image

CONFIG = """
seed = 5
[env]
name = "breakout"
limit_steps = 30
[reward]
source = "perceptual"
descriptor = "window"
goal = "goal.png"
[train]
steps = {steps}
environments = 4
batch_size = 8
replay_steps = 400
learning_starts = 100
steps_per_update = 16
threads = 1
checkpoint_every_steps = 200
[evaluation]
every_episodes = 8
episodes = 3
[record]
training_every_episodes = 5
"""
# For any command.
PATIENCE_S = 120


def prf(folder: Path, *args: str) -> None:
    subprocess.run([os.environ["PRF"], *args], cwd=folder, check=True, timeout=PATIENCE_S, stdout=subprocess.DEVNULL)


def set_up(folder: Path, steps: int) -> None:
    """The goal, a piece of a wall, and a config of a run that takes so many steps."""
    goal = Image.new("L", (24, 12))
    goal.paste(160, (0, 0, 24, 6))
    goal.save(folder / "goal.png")
    (folder / "c.toml").write_text(CONFIG.format(steps=steps))


@pytest.fixture(scope="session")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that came to its end."""
    folder = tmp_path_factory.mktemp("finished")
    set_up(folder, 600)
    prf(folder, "train", "c.toml", "--out", "run")
    return folder / "run"


@pytest.fixture(scope="session")
def killed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a run that was killed once it had a checkpoint; `c.toml` lies beside it."""
    folder = tmp_path_factory.mktemp("killed")
    set_up(folder, 2_000)
    with subprocess.Popen([os.environ["PRF"], "train", "c.toml", "--out", "run"], cwd=folder, stderr=sys.stderr) as run:
        end = time.monotonic() + PATIENCE_S
        try:
            while not list(folder.glob("run/checkpoints/step-*00")):
                assert run.poll() is None and time.monotonic() < end, "the run made no checkpoint"
                time.sleep(0.01)
        finally:
            run.kill()
    return folder / "run"


def called(module: str, *args: str) -> subprocess.CompletedProcess[str]:
    """A program of the environment that the tests run in."""
    program = Path(sys.executable).parent / module
    return subprocess.run([program, *args], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
