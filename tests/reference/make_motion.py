#!/usr/bin/env python3
"""Writes ../golden/motion: sequences of pictures, and OpenCV's motion history of them.

    python3 -m venv .venv && .venv/bin/pip install -r tests/reference/requirements.txt
    .venv/bin/python tests/reference/make_motion.py

Running it again gives the same bytes. `index.json` lists the cases in the order of their data; `pictures.u8`
holds all pictures and `history.f32` the history after each iteration, as little-endian 32-bit floats.

- "observe": frames of a camera that moves over a natural picture. Their silhouettes are
  `absdiff` and `threshold(THRESH_BINARY)`, the times those of the schedule. Some movements get exactly
  as old as the duration; as OpenCV's wheels take the difference of both times in 32 bits, they toss a coin there. So they
  are given durations that are longer by a millionth, which keeps such movements, as exact arithmetic does.
- "update": silhouettes of noise, with a timestamp and a duration for each, as they are.
"""

import json
from pathlib import Path

import cv2
import numpy as np
from PIL import Image
from skimage import data

OUT = Path(__file__).resolve().parent.parent / "golden" / "motion"


def walk(picture, corner, width, height, steps):
    """Crops of the picture, whose corner (x, y) goes on by a step from one to the next."""
    corners = np.cumsum([corner, *steps], axis=0)
    return [np.ascontiguousarray(picture[y : y + height, x : x + width]) for x, y in corners]


def observe_cases():
    """(frames, parameters)"""
    still, right, back, down = (0, 0), (2, 0), (-1, 0), (0, 3)
    # Still at the end, so that what moved is forgotten bit by bit; at iterations 5, 11 and 17 a movement of
    # the paper's schedules is exactly as old as it may get.
    steps = [right, right, down, still, back, right, still, still] + 10 * [still]
    astronaut = np.asarray(Image.fromarray(data.astronaut()).convert("L"))
    camera, coins = data.camera(), data.coins()
    robot = {"threshold": 30, "tau_start": 0.1, "tau_step": 0.4, "delta": {"divisor": 3.0}}
    human = {"threshold": 12, "tau_start": 0.1, "tau_step": 0.3, "delta": {"divisor": 4.0}}
    short = {"threshold": 0, "tau_start": 0.7, "tau_step": 0.1, "delta": {"duration": 0.3}}
    now = {"threshold": 40, "tau_start": 1.0, "tau_step": 1.0, "delta": {"duration": 0.0}}
    yield walk(camera, (215, 95), 23, 17, steps), robot
    yield walk(astronaut, (205, 75), 19, 22, steps), human
    yield walk(coins, (60, 40), 31, 9, steps[:9]), short
    yield walk(coins, (80, 50), 7, 13, steps[:6]), now


def update_cases():
    """(silhouettes, [(timestamp, duration)])"""
    rng = np.random.default_rng(7)
    seconds = [(0.1 * k, 0.3) for k in range(9)]
    milliseconds = [(33.4 * k + 1e6, 100.0) for k in range(8)]
    uneven = [(0.0, 0.5), (0.1, 0.5), (0.1, 0.0), (2.5, 2.4), (2.6, 9.0), (7.0, 4.4), (7.0, 1e9)]
    for width, height, times in [(29, 12, seconds), (17, 11, milliseconds), (1, 40, uneven)]:
        values = np.array([0, 0, 0, 1, 128, 255], np.uint8)
        yield [rng.choice(values, (height, width)) for _ in times], times


def histories(silhouettes, times):
    """What is left of the silhouettes up to each of the times."""
    history = np.zeros(silhouettes[0].shape, np.float32)
    for silhouette, (timestamp, duration) in zip(silhouettes, times, strict=True):
        cv2.motempl.updateMotionHistory(silhouette, history, timestamp, duration)
        yield history.copy()


def silhouettes_of(frames, threshold):
    for before, frame in zip(frames, frames[1:]):
        yield cv2.threshold(cv2.absdiff(before, frame), threshold, 1, cv2.THRESH_BINARY)[1]


def schedule(params, iterations):
    for t in range(iterations):
        (kind, value), = params["delta"].items()
        delta = (t + 1) / value if kind == "divisor" else value
        yield params["tau_start"] + params["tau_step"] * t, delta * (1 + 1e-6)


def main():
    OUT.mkdir(parents=True, exist_ok=True)
    index, pictures, results = [], [], []

    def add(images, kind, silhouettes, times):
        height, width = images[0].shape
        index.append({"width": width, "height": height, "pictures": len(images), "input": kind})
        pictures.extend(images)
        results.extend(histories(silhouettes, times))

    for frames, params in observe_cases():
        silhouettes = list(silhouettes_of(frames, params["threshold"]))
        add(frames, {"observe": params}, silhouettes, schedule(params, len(silhouettes)))
    for silhouettes, times in update_cases():
        add(silhouettes, {"update": times}, silhouettes, times)
    (OUT / "pictures.u8").write_bytes(b"".join(p.tobytes() for p in pictures))
    (OUT / "history.f32").write_bytes(b"".join(r.astype("<f4").tobytes() for r in results))
    lines = ",\n".join("  " + json.dumps(case) for case in index)
    (OUT / "index.json").write_text(f"[\n{lines}\n]\n")
    print(f"{len(index)} cases, {len(results)} iterations in {OUT.name}/")


if __name__ == "__main__":
    main()
