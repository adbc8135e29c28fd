"""``python -m prf``: the contract that scripts rely on."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command import prf as run
from pictures import Bytes, boxes, natural
from skimage.io import imread, imsave

import prf

GOAL = natural(40, 53)
FRAMES = {"natural.png": natural(40, 53, seed=2), "boxes.png": boxes(61, 48)}


def save(path: Path, picture: Bytes) -> None:
    imsave(path, picture, check_contrast=False)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Has a goal, two frames and a file that is no picture."""
    for name, picture in {"goal.png": GOAL, **FRAMES}.items():
        save(tmp_path / name, picture)
    (tmp_path / "broken.png").write_bytes((tmp_path / "goal.png").read_bytes()[:-40])
    return tmp_path


def records(text: str) -> list[dict[str, Any]]:
    return [json.loads(line) for line in text.splitlines()]


@pytest.mark.parametrize(
    ("options", "arguments"),
    [
        ([], {}),
        (
            ["--cell-px=4", "--block-cells=2", "--norm=l2-hys"],
            {"cell_px": 4, "block_cells": 2, "norm": "l2-hys"},
        ),
        (["--cell=0.1", "--orientations=5", "--signed"], {"cell": 0.1, "orientations": 5, "signed": True}),
        (["--scale=sqrt-features", "--norm=l1-sqrt"], {"scale": "sqrt-features", "norm": "l1-sqrt"}),
    ],
)
def test_scores_are_those_of_the_functions_to_the_bit(
    folder: Path, options: list[str], arguments: dict[str, Any]
) -> None:
    ended = run(folder, "score", "goal.png", *FRAMES, "--format", "json", *options)
    assert (ended.returncode, ended.stderr) == (0, "")
    for index, (record, (name, frame)) in enumerate(zip(records(ended.stdout), FRAMES.items(), strict=True)):
        assert record.keys() == {"source", "index", "reward", "distance"}
        assert (record["source"], record["index"]) == (name, index)
        # JSON has as many digits as tell one float32 from the next.
        assert float(np.float32(record["reward"])) == prf.reward(GOAL, frame, **arguments)
        assert float(np.float32(record["distance"])) == prf.distance(GOAL, frame, **arguments)


def test_the_best_match_of_a_window_is_told(folder: Path) -> None:
    save(folder / "window.png", GOAL[10:30, 20:44])
    ended = run(folder, "score", "window.png", "goal.png", "--descriptor", "window", "--format", "json")
    [record] = records(ended.stdout)
    assert record["reward"] == 1
    assert record["match"].keys() == {"x", "y", "width", "height", "score"}
    assert [record["match"][key] for key in ("x", "y", "width", "height")] == [20, 10, 24, 20]


def test_text_is_for_people(folder: Path) -> None:
    ended = run(folder, "score", "goal.png", "goal.png")
    assert (ended.returncode, ended.stdout, ended.stderr) == (
        0,
        "goal.png: reward 1.000000, distance 0.000000\n",
        "",
    )


def test_what_is_lost_is_told_and_ends_with_3(folder: Path) -> None:
    ended = run(folder, "score", "goal.png", "goal.png", "broken.png", "nowhere.png", "--format", "json")
    assert ended.returncode == 3
    assert [record["source"] for record in records(ended.stdout)] == ["goal.png"]
    told = ended.stderr.splitlines()
    assert [line.split(": ")[:2] for line in told] == [["error", "broken.png"], ["error", "nowhere.png"]]


@pytest.mark.parametrize(
    ("arguments", "code", "told"),
    [
        (["score", "nowhere.png", "goal.png"], 1, "error: nowhere.png: no such file"),
        (["score", "goal.png", "nowhere.png"], 1, "error: no frame could be scored"),
        (["train", "breakout.toml"], 1, "built without training"),
        (["eval", "run"], 1, "cargo install"),
        ([], 2, "Usage: python -m prf <COMMAND>"),
        (["scor"], 2, "Usage: python -m prf"),
        (["score", "goal.png"], 2, "Usage: python -m prf score"),
        (["score", "goal.png", "goal.png", "--cell=-1"], 2, "error: --cell: got -1"),
    ],
)
def test_failure_ends_with_1_and_misuse_with_2(
    folder: Path, arguments: list[str], code: int, told: str
) -> None:
    ended = run(folder, *arguments)
    assert (ended.returncode, ended.stdout) == (code, "")
    assert told in ended.stderr
    assert "Traceback" not in ended.stderr


def test_help_and_version_name_the_program(tmp_path: Path) -> None:
    assert run(tmp_path, "--version").stdout == f"prf {prf.__version__}\n"
    assert "Usage: python -m prf <COMMAND>" in run(tmp_path, "--help").stdout
    assert "Usage: python -m prf score [OPTIONS] <GOAL> <FRAME>..." in run(tmp_path, "score", "--help").stdout


def test_the_other_commands_are_there(tmp_path: Path) -> None:
    """A preset, what is to be thought of its reward, an episode of its world, and what that scores."""

    def results(*arguments: str) -> str:
        ended = run(tmp_path, *arguments)
        assert ended.returncode == 0, ended.stderr
        return ended.stdout

    assert results("init", "breakout") == "goals/black.png\nbreakout.toml\n"
    [verdict] = records(results("inspect", "breakout.toml", "--format", "json"))
    assert verdict["verdict"] == "good"
    assert "\n[reward]\n" in results("tune", "breakout.toml")

    results("play", "breakout", "--player", "oracle", "--steps", "9", "--frames", "frames")
    scored = results("score", "goals/black.png", "frames", "--config", "breakout.toml", "--format", "json")
    assert [record["index"] for record in records(scored)] == list(range(10))

    results("goal", "crop", "frames/0000.png", "--rect", "10,20,30,40", "--out", "cut.png")
    assert imread(tmp_path / "cut.png").shape == (40, 30)
    assert "breakout" in [world["name"] for world in records(results("worlds", "--format", "json"))]
    assert "score" in results("completions", "bash")
