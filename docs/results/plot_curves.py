"""Draws the learning curves of docs/results from the committed records of the runs.

    python -m pip install matplotlib==3.10.7
    python docs/results/plot_curves.py breakout flappy kobian-happy kobian-surprise

The oracle's and the random player's scores are means over 1,000 episodes, as
`cargo run --release -p prf-envs --example score_players -- WORLD` prints them.
"""

import json
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "prf"
import matplotlib.pyplot as plt

HERE = Path(__file__).parent
GREEN, RED, BLUE = "#0b6e4f", "#c8553d", "#33658a"


@dataclass
class Figure:
    records: str  # the folder and the beginning of the records' names
    series: dict[str, tuple[str, str]]  # what follows in a record's name: label and colour
    lines: dict[str, float]  # players to compare with
    bottom: float
    legend: tuple[str, float]  # corner and height of the legend


FACES = {
    "vrf": ("VRF: distance of the vertices", RED),
    "kprf": ("KPRF: goal = the face's own movement", GREEN),
    "hprf": ("HPRF: goal = a person's movement", BLUE),
}
FIGURES = {
    "breakout": Figure(
        "breakout/",
        {"prf": ("perceptual reward, goal = a black picture", GREEN), "vrf": ("the game's own points", RED)},
        {"oracle": 3.433, "90 % of the oracle": 0.9 * 3.433, "random player": 0.374},
        0,
        ("lower right", 0.1),
    ),
    "flappy": Figure(
        "flappy/",
        {"prf": ("perceptual reward, goal = a cut-out", GREEN), "vrf": ("the game's own reward", RED)},
        {"oracle": 166, "10 pairs": 10},
        0,
        ("upper left", 0.92),
    ),
    "kobian-happy": Figure("kobian/happy-", FACES, {"oracle": 0, "random player": -9.408}, -19, ("lower right", 0)),
    "kobian-surprise": Figure("kobian/surprise-", FACES, {"oracle": 0, "random player": -10.196}, -21, ("lower right", 0)),
}


def curve(path: Path) -> tuple[list[float], list[float]]:
    records = [json.loads(line) for line in path.read_text().splitlines()]
    points = [(r["step"], r["mean_score"]) for r in records if r["kind"] == "evaluation"]
    return [step / 1000 for step, _ in points], [score for _, score in points]


def draw(name: str, figure: Figure) -> None:
    canvas, axes = plt.subplots(figsize=(7.5, 4.2), layout="constrained")
    for kind, (label, colour) in figure.series.items():
        for index, path in enumerate(sorted(HERE.glob(f"{figure.records}{kind}-*.jsonl"))):
            steps, scores = curve(path)
            axes.plot(steps, scores, color=colour, linewidth=1.3, alpha=0.85, label=label if index == 0 else None)
    top = max(figure.lines.values())
    for label, score in figure.lines.items():
        axes.axhline(score, color="#555555", linewidth=0.9, linestyle=":" if "0 " in label else "--")
        # The curves begin at the random player's score, so its name stands at the other end.
        end, side = (1.0, "right") if label == "random player" else (0.0, "left")
        axes.annotate(label, (end, score), xycoords=("axes fraction", "data"), fontsize=8, color="#555555",
                      ha=side, va="bottom", xytext=(4 if side == "left" else -4, 1), textcoords="offset points")
    axes.set_xlabel("steps, in thousands (one line a seed)")
    axes.set_ylabel("mean score of the greedy agent")
    axes.set_ylim(figure.bottom, top + 0.1 * (top - figure.bottom))
    axes.set_xlim(0, None)
    axes.spines[["top", "right"]].set_visible(False)
    corner, height = figure.legend
    axes.legend(frameon=False, loc=corner, bbox_to_anchor=(1 if "right" in corner else 0, height))
    canvas.savefig(HERE / f"{name}.svg", metadata={"Date": None})
    plt.close(canvas)


def main() -> None:
    for name in sys.argv[1:]:
        draw(name, FIGURES[name])


if __name__ == "__main__":
    main()
