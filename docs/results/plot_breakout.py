"""Draws breakout.svg from the committed records of the runs.

    python -m pip install matplotlib==3.10.7
    python docs/results/plot_breakout.py ORACLE_SCORE RANDOM_SCORE

The two scores are means over 1,000 episodes, as `cargo run --release -p prf-envs --example score_players` prints them.
"""

import json
import sys
from pathlib import Path

import matplotlib

matplotlib.use("svg")
matplotlib.rcParams["svg.hashsalt"] = "prf"
import matplotlib.pyplot as plt

HERE = Path(__file__).parent
SOURCES = {
    "prf": ("perceptual reward, goal = a black picture", "#0b6e4f"),
    "vrf": ("the game's own points", "#c8553d"),
}


def curve(path: Path) -> tuple[list[int], list[float]]:
    records = [json.loads(line) for line in path.read_text().splitlines()]
    points = [(r["step"], r["mean_score"]) for r in records if r["kind"] == "evaluation"]
    return [step / 1000 for step, _ in points], [score for _, score in points]


def main() -> None:
    oracle, random = float(sys.argv[1]), float(sys.argv[2])
    figure, axes = plt.subplots(figsize=(7.5, 4.2), layout="constrained")
    for name, (label, colour) in SOURCES.items():
        for index, path in enumerate(sorted((HERE / "breakout").glob(f"{name}-*.jsonl"))):
            steps, scores = curve(path)
            axes.plot(steps, scores, color=colour, linewidth=1.3, alpha=0.85, label=label if index == 0 else None)
    for score, label in [(oracle, "oracle"), (0.9 * oracle, "90 % of the oracle"), (random, "random player")]:
        axes.axhline(score, color="#555555", linewidth=0.9, linestyle=":" if "%" in label else "--")
        # The curves begin at the random player's score, so its name stands at the other end.
        end, side = (1.0, "right") if score == random else (0.0, "left")
        axes.annotate(label, (end, score), xycoords=("axes fraction", "data"), fontsize=8, color="#555555",
                      ha=side, va="bottom", xytext=(4 if side == "left" else -4, 1), textcoords="offset points")
    axes.set_xlabel("steps, in thousands (one line a seed)")
    axes.set_ylabel("mean score of the greedy agent")
    axes.set_ylim(0, 1.1 * oracle)
    axes.set_xlim(0, None)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, loc="lower right", bbox_to_anchor=(1, 0.1))
    figure.savefig(HERE / "breakout.svg", metadata={"Date": None})


if __name__ == "__main__":
    main()
