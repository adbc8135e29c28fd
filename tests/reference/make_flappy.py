#!/usr/bin/env python3
"""Writes ../golden/flappy: screens of a rough Flappy Bird with what is known of each, to judge rewards by.

    python3 -m venv .venv && .venv/bin/pip install -r tests/reference/requirements.txt
    .venv/bin/python tests/reference/make_flappy.py

Running it again with the same versions gives the same bytes. `frames.png` is an animated PNG of 400 screens of 84x84 px; `scores.csv`
has a line for each: `success` is 1 where the bird is between two pipes and touches neither, `score` is minus the bird's distance
in pixels from the middle of the gap, while it is between the pipes' sides. `screen.png` shows the bird in the middle
of a gap, `goal.png` is its part of 20x32 px around the bird.

This world only has to show what an innocent choice of window, cell and norm does to a reward; it is nobody's game. Where the bird is
not in its place, a gap without the bird is often the better match.
"""

from pathlib import Path

import numpy as np
from PIL import Image

OUT = Path(__file__).resolve().parent.parent / "golden" / "flappy"
SIDE, GAP, PIPE, SPACING, FRAMES = 84, 26, 16, 52, 400
BIRD_X, BIRD_WIDTH, BIRD_HEIGHT = 20, 7, 6
GRAVITY, FLAP, FASTEST, SPEED = 0.42, -2.4, 3.5, 1.5


def draw(pipes, bird_y):
    """Pipes are (left side, top of the gap)."""
    screen = np.zeros((SIDE, SIDE), np.uint8)

    def fill(x, y, width, height, value):
        screen[max(y, 0) : max(y + height, 0), max(x, 0) : max(x + width, 0)] = value

    for x, top in pipes:
        x, below = int(round(x)), top + GAP
        fill(x, 0, PIPE, top, 110)
        fill(x, below, PIPE, SIDE - below, 110)
        fill(x - 1, top - 3, PIPE + 2, 3, 150)
        fill(x - 1, below, PIPE + 2, 3, 150)
    y = int(round(bird_y))
    fill(BIRD_X, y, BIRD_WIDTH, BIRD_HEIGHT, 220)
    fill(BIRD_X + 4, y + 1, 2, 2, 255)
    fill(BIRD_X + 5, y + 3, 2, 2, 180)
    return screen


def new_pipe(rng, x):
    return [x, int(rng.integers(8, SIDE - GAP - 8))]


def episode(rng, steps=60):
    """Screens of a player of random skill, which may touch pipes: (screen, score or None, success)."""
    pipes = [new_pipe(rng, 60.0)]
    y, speed, skill = 38.0, 0.0, rng.random()
    for _ in range(steps):
        for pipe in pipes:
            pipe[0] -= SPEED
        pipes = [pipe for pipe in pipes if pipe[0] > -PIPE - 2]
        if pipes[-1][0] < SIDE - SPACING:
            pipes.append(new_pipe(rng, SIDE + float(rng.integers(0, 8))))
        left, top = next(pipe for pipe in pipes if pipe[0] + PIPE > BIRD_X - 1)
        aim = top + GAP / 2 - BIRD_HEIGHT / 2 + rng.normal(0, 5)
        flaps = y > aim and speed > -0.5 if rng.random() < skill else rng.random() < 0.14
        speed = FLAP if flaps else min(speed + GRAVITY, FASTEST)
        y = float(np.clip(y + speed, 0, SIDE - BIRD_HEIGHT))
        at_pipes = left <= BIRD_X + BIRD_WIDTH // 2 < left + PIPE
        drawn = int(round(y))
        inside = at_pipes and drawn >= top and drawn + BIRD_HEIGHT <= top + GAP
        off = abs(drawn + BIRD_HEIGHT / 2 - (top + GAP / 2))
        yield draw(pipes, y), 0 - off if at_pipes else None, inside
        if at_pipes and not inside and rng.random() < 0.15:
            return


def main():
    rng, shown = np.random.default_rng(1), []
    while len(shown) < FRAMES:
        shown += list(episode(rng))[::2]
    shown = shown[:FRAMES]
    OUT.mkdir(exist_ok=True)
    first, *rest = [Image.fromarray(screen) for screen, _, _ in shown]
    first.save(OUT / "frames.png", save_all=True, append_images=rest, duration=100, loop=0, optimize=True)
    lines = [f"{'' if score is None else format(score, 'g')},{int(success)}" for _, score, success in shown]
    (OUT / "scores.csv").write_text("\n".join(["score,success", *lines, ""]))
    top, middle = 29, BIRD_X + BIRD_WIDTH // 2
    screen = draw([(middle - PIPE // 2, top)], top + GAP / 2 - BIRD_HEIGHT / 2)
    Image.fromarray(screen).save(OUT / "screen.png", optimize=True)
    x, y = middle - 10, top + GAP // 2 - 16
    Image.fromarray(screen[y : y + 32, x : x + 20]).save(OUT / "goal.png", optimize=True)


main()
