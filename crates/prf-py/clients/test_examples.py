"""The examples and the notebook, run as a user runs them, with few steps; what they learn in full is in docs/results/python.md."""

import json
import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import gymnasium as gym
import nbformat
import pytest
from gymnasium.wrappers import ReshapeObservation
from nbclient import NotebookClient
from stable_baselines3.common.env_checker import check_env

import prf  # noqa: F401: its import registers the environments

EXAMPLES = Path(__file__).resolve().parents[1] / "examples"
NAMES = ["PRF/Breakout-v0", "PRF/FlappyBird-v0", "PRF/KobianFace-v0"]


def run(script: str, *args: str) -> dict[str, Any]:
    """What the last line that an example prints says."""
    done = subprocess.run(
        [sys.executable, str(EXAMPLES / script), *args], capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, done.stderr
    result: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return result


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("reward", ["perceptual", "variable"])
def test_stable_baselines3_finds_no_fault_with_an_environment(name: str, reward: str) -> None:
    # Its networks for pictures want an axis for colours.
    check_env(ReshapeObservation(gym.make(name, reward=reward), (84, 84, 1)), skip_render_check=True)


@pytest.mark.parametrize(("algorithm", "name"), [("dqn", "PRF/Breakout-v0"), ("ppo", "PRF/KobianFace-v0")])
def test_stable_baselines3_trains_on_a_world(algorithm: str, name: str) -> None:
    result = run("sb3_worlds.py", algorithm, name, "--steps", "256", "--episodes", "2")
    assert result["steps"] == 256
    for who in ("random", "learned"):
        assert result[f"{who}_return"] > 0, "a perceptual reward is above 0"
        assert math.isfinite(result[f"{who}_score"])


def test_a_pendulum_is_rewarded_by_a_picture() -> None:
    result = run("pendulum_from_a_picture.py", "--steps", "120", "--episodes", "1")
    # Pendulum-v1's own reward is -16.3 at worst, in each of 200 steps.
    for who in ("mean", "random_mean"):
        assert -200 * 16.3 < result[who] < 0


def test_the_notebook_runs_from_top_to_bottom() -> None:
    notebook = nbformat.read(EXAMPLES / "rewards_from_pictures.ipynb", as_version=4)  # type: ignore[no-untyped-call]
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(EXAMPLES)}}).execute()
    said = [output.text for cell in notebook.cells for output in cell.get("outputs", []) if output.output_type == "stream"]
    assert "rank correlation" in "".join(said)
