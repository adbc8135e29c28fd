#!/usr/bin/env python3
"""Writes ../golden/matching: crops of natural pictures, and what OpenCV's matchTemplate says of them.

    python3 -m venv .venv && .venv/bin/pip install -r tests/reference/requirements.txt
    .venv/bin/python tests/reference/make_matching.py

Running it again gives the same bytes. `index.json` lists the cases, with the best match as OpenCV's minMaxLoc finds it;
`scores.f32` holds their maps one after the other, row by row, as little-endian 32-bit floats.

Templates are crops too, some of them of the very frame that they are looked for in, some made brighter and noisier. The
frames have no nearly flat windows: for those OpenCV has rules of its own, and already where grey varies by less than
5 levels its 32-bit sums are off by 1e-4. Every map is checked to be within 2e-5 of the definition in 64 bits.
"""

import json
from pathlib import Path

import cv2
import numpy as np
from PIL import Image
from skimage import data

OUT = Path(__file__).resolve().parent.parent / "golden" / "matching"
METHODS = {"ccorr-normed": cv2.TM_CCORR_NORMED, "ccoeff-normed": cv2.TM_CCOEFF_NORMED}


def altered(picture):
    noise = np.random.default_rng(7).normal(0, 6, picture.shape)
    return np.clip(0.7 * picture + 40 + noise, 0, 255).round().astype(np.uint8)


def disc(height, width):
    y, x = np.mgrid[:height, :width]
    inside = ((2 * x + 1) / width - 1) ** 2 + ((2 * y + 1) / height - 1) ** 2 <= 1
    return np.where(inside, 255, 0).astype(np.uint8)


def stripes(height, width):
    """No two rows alike, and few runs longer than some pixels."""
    y, x = np.mgrid[:height, :width]
    return np.where((x + y * y) % 5 < 3, 1, 0).astype(np.uint8)


def pictures():
    """Name to bytes, of odd sizes."""
    astronaut = np.asarray(Image.fromarray(data.astronaut()).convert("L"))
    camera, coins = data.camera(), data.coins()
    frames = {
        "camera-43x41": camera[464:505, 384:427],
        "astronaut-87x73": astronaut[60:133, 180:267],
        "camera-91x77": camera[75:152, 190:281],
        "coins-57x31": coins[40:71, 60:117],
        "coins-101x67": coins[20:87, 30:131],
    }
    templates = {
        "astronaut-31x37": altered(astronaut[70:107, 200:231]),
        "camera-9x7": camera[474:481, 399:408],
        "camera-45x33": camera[90:123, 210:255],
        "camera-elsewhere-53x41": camera[300:341, 220:273],
        "coins-39x43": altered(coins[30:73, 60:99]),
        "coins-whole-101x67": altered(coins[20:87, 30:131]),
        "coins-row-29x1": coins[50:51, 70:99],
        "mask-disc-45x33": disc(33, 45),
        "mask-disc-9x7": disc(7, 9),
        "mask-stripes-39x43": stripes(43, 39),
    }
    return frames | templates


def cases():
    """(frame, template, mask)"""
    yield "astronaut-87x73", "astronaut-31x37", None
    yield "camera-43x41", "camera-9x7", None
    yield "camera-43x41", "camera-9x7", "mask-disc-9x7"
    yield "camera-91x77", "camera-45x33", None
    yield "camera-91x77", "camera-45x33", "mask-disc-45x33"
    yield "camera-91x77", "camera-elsewhere-53x41", None
    yield "coins-101x67", "coins-39x43", None
    yield "coins-101x67", "coins-39x43", "mask-stripes-39x43"
    yield "coins-57x31", "coins-row-29x1", None
    yield "coins-101x67", "coins-whole-101x67", None


def definition(frame, template, method, mask):
    """Scores of all windows in 64 bits."""
    counts = np.ones(template.shape, bool) if mask is None else mask != 0
    windows = np.lib.stride_tricks.sliding_window_view(frame, template.shape)[..., counts].astype(float)
    values = template[counts].astype(float)
    if method == "ccoeff-normed":
        windows, values = windows - windows.mean(-1, keepdims=True), values - values.mean()
    return windows @ values / np.sqrt((windows**2).sum(-1) * (values**2).sum())


def main():
    OUT.mkdir(parents=True, exist_ok=True)
    images = pictures()
    for name, image in images.items():
        Image.fromarray(image).save(OUT / f"{name}.png", optimize=True)
    index, maps = [], []
    for frame, template, mask in cases():
        for name, method in METHODS.items():
            scores = cv2.matchTemplate(images[frame], images[template], method, mask=images.get(mask))
            expected = definition(images[frame], images[template], name, images.get(mask))
            assert np.abs(scores - expected).max() < 2e-5, (frame, template, mask, name)
            _, best, _, (x, y) = cv2.minMaxLoc(scores)
            case = {"frame": frame, "template": template, "mask": mask, "method": name}
            index.append(case | {"shape": scores.shape, "best": [x, y]})
            maps.append(scores.astype("<f4"))
            runner_up = np.sort(scores, axis=None)[-2:][0]
            print(f"{frame} {template} {mask} {name}: {best:.6f} at {x}, {y}, next {runner_up:.6f}")
    (OUT / "scores.f32").write_bytes(np.concatenate([m.ravel() for m in maps]).tobytes())
    lines = ",\n".join("  " + json.dumps(case) for case in index)
    (OUT / "index.json").write_text(f"[\n{lines}\n]\n")
    print(f"{len(index)} cases, {sum(m.size for m in maps)} scores in {OUT.name}/")


if __name__ == "__main__":
    main()
