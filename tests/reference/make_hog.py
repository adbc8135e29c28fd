#!/usr/bin/env python3
"""Writes ../golden/hog: crops of natural pictures, and what scikit-image's HOG says of them.

    python3 -m venv .venv && .venv/bin/pip install -r tests/reference/requirements.txt
    .venv/bin/python tests/reference/make_hog.py

Running it again gives the same bytes. `index.json` lists the cases; `features.f32` holds their
features one after the other as little-endian 32-bit floats, computed in 64 bits.

A case's `input` says what scikit-image was given:

- "bytes": the picture divided by 255, in 64 bits. For 4, 8, 12, ... orientations some gradients of
  bytes lie exactly on the border of two bins, where the rounding of that division would toss a coin; there the
  histograms are scikit-image's of the exact, whole-numbered gradients.
- "floats": the picture divided by 255 in 32 bits, which scikit-image keeps.
"""

import itertools
import json
from pathlib import Path

import numpy as np
from PIL import Image
from skimage import data
from skimage.feature import _hog, _hoghistogram, hog

OUT = Path(__file__).resolve().parent.parent / "golden" / "hog"
NORMS = {"l1": "L1", "l1-sqrt": "L1-sqrt", "l2": "L2", "l2-hys": "L2-Hys"}


def pictures():
    """Name to bytes; odd sizes, with edges, texture, and skies of hardly any gradient."""
    astronaut = np.asarray(Image.fromarray(data.astronaut()).convert("L"))
    return {
        "astronaut-47x61": astronaut[60:121, 190:237],
        "camera-84x84": data.camera()[70:154, 180:264],
        "coins-100x75": data.coins()[20:95, 30:130],
        "coins-23x31": data.coins()[40:71, 60:83],
    }


def cases():
    """(picture, orientations, cell_px, block_cells, norm, input)"""
    for (picture, cell), block, norm in itertools.product(
        [("astronaut-47x61", 5), ("camera-84x84", 8), ("coins-100x75", 8)], (1, 2, 3), NORMS
    ):
        yield picture, 9, cell, block, norm, "bytes"
    for norm in ("none", "l2"):
        yield "camera-84x84", 9, 2, 1, norm, "bytes"
    for cell, norm in itertools.product((1, 3), ("l1-sqrt", "l2")):
        yield "coins-23x31", 9, cell, 1, norm, "bytes"
    yield "astronaut-47x61", 9, 47, 1, "l2", "bytes"
    for orientations, kind in itertools.product((1, 2, 7, 8, 12, 16), ("bytes", "floats")):
        for norm in ("none", "l2-hys"):
            yield "astronaut-47x61", orientations, 6, 2, norm, kind
    for norm in NORMS:
        yield "camera-84x84", 9, 8, 2, norm, "floats"


def features(picture, orientations, cell, block, norm, kind):
    image = picture.astype(np.float32) / np.float32(255) if kind == "floats" else picture / 255.0
    tossed = kind == "bytes" and orientations % 4 == 0
    if norm != "none" and not tossed:
        return hog(
            image.astype(np.float64) if kind == "bytes" else image,
            orientations,
            (cell, cell),
            (block, block),
            NORMS[norm],
        )
    rows, columns = _hog._hog_channel_gradient(picture.astype(float) if tossed else image)
    histograms = histograms_of(rows.astype(float), columns.astype(float), orientations, cell)
    return blocks_of(histograms / 255 if tossed else histograms, block, norm)


def histograms_of(rows, columns, orientations, cell):
    height, width = rows.shape
    down, across = height // cell, width // cell
    histograms = np.zeros((down, across, orientations))
    _hoghistogram.hog_histograms(
        columns, rows, cell, cell, width, height, across, down, orientations, histograms
    )
    return histograms


def blocks_of(histograms, block, norm):
    """What the last part of skimage.feature.hog does; without a norm it can't be asked to."""
    down, across, _ = histograms.shape
    blocks = [
        histograms[y : y + block, x : x + block]
        for y in range(down - block + 1)
        for x in range(across - block + 1)
    ]
    if norm != "none":
        blocks = [_hog._hog_normalize_block(b, NORMS[norm]) for b in blocks]
    return np.concatenate([b.ravel() for b in blocks])


def main():
    OUT.mkdir(parents=True, exist_ok=True)
    images = pictures()
    for name, image in images.items():
        Image.fromarray(image).save(OUT / f"{name}.png", optimize=True)
    index, values = [], []
    for picture, orientations, cell, block, norm, kind in cases():
        row = features(images[picture], orientations, cell, block, norm, kind)
        index.append(
            {
                "picture": picture,
                "input": kind,
                "hog": {
                    "orientations": orientations,
                    "cell": {"px": cell},
                    "block_cells": block,
                    "norm": norm,
                },
                "len": len(row),
            }
        )
        values.append(row.astype("<f4"))
    (OUT / "features.f32").write_bytes(np.concatenate(values).tobytes())
    lines = ",\n".join("  " + json.dumps(case) for case in index)
    (OUT / "index.json").write_text(f"[\n{lines}\n]\n")
    print(f"{len(index)} cases, {sum(map(len, values))} features in {OUT.name}/")


if __name__ == "__main__":
    main()
