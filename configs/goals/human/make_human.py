#!/usr/bin/env python3
"""Writes happy/ and surprise/: a human face that goes from neutral to an expression, as small grey pictures.

    python3 -m venv .venv
    .venv/bin/pip install numpy==2.4.6 pillow==13.0.0 scikit-image==0.26.0 scipy==1.17.1
    .venv/bin/python configs/goals/human/make_human.py
    .venv/bin/python configs/goals/human/make_human.py --check    # only compares with the pictures that are there

Running it again with the same versions gives the same bytes. The face is Eileen Collins's in the portrait that scikit-image
carries as `data.astronaut()` (NASA, public domain). She smiles in it: a smooth warp closes her mouth for the neutral face,
from which the smile is the way back. All positions are (x, y) in pixels of the pictures.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image
from scipy import ndimage
from scipy.interpolate import RBFInterpolator
from skimage import data, exposure

OUT = Path(__file__).resolve().parent
EXPRESSIONS = ("happy", "surprise")
WIDTH, HEIGHT, FRAMES, SCALE = 144, 160, 9, 2  # drawn SCALE times as large, then averaged
PORTRAIT_EYES, EYES = (203.4 + 101.2j, 246.6 + 103.2j), (46 + 56j, 98 + 56j)  # x + iy
DARK = 34.0  # grey between the lips

# The portrait's lips from corner to corner; then its brows, and its folds from nose to mouth, left and right
UPPER_OUTER = [(47, 101), (56, 100.6), (63, 100.2), (68, 100.6), (71, 101.2), (74.5, 100.8), (80, 100.3), (86, 100.4), (97, 101)]
UPPER_INNER = [(47, 101), (52.3, 103), (57, 104.1), (62, 104.9), (67.3, 105.6), (71, 105.7), (76.5, 105.2), (81, 104.4), (91, 102.2), (97, 101)]
LOWER_INNER = [(47, 101), (51.6, 105.5), (56, 108.8), (60, 111.3), (65, 112.4), (71, 112.5), (76, 112), (81.5, 111.2), (91, 105.9), (97, 101)]
LOWER_OUTER = [(47, 101), (51, 107), (55, 111), (59.4, 114.6), (65, 117.6), (71.5, 118.6), (77.3, 118.1), (83.7, 115.9), (90, 110.9), (97, 101)]
BROWS = [[(29.5, 43.3), (33.7, 41.8), (38.7, 41), (43.7, 41.4), (50, 42.4), (57, 44.6)],
         [(87, 44.2), (91, 43.6), (96, 42.9), (101, 42.3), (106.6, 42.1), (110, 43), (114.5, 45.5)]]
FOLDS = [[(38.5, 101), (40, 97), (45, 90.5), (52, 82)], [(91, 83), (99, 91), (104, 98), (104.5, 104)]]
SHINE = [(60, 115), (72, 116)]  # a highlight on the lower lip

# What else moves: where it is in the portrait, and how far it is from there in the neutral and in the surprised face
FACE = [
    # Folds
    ((40, 97), (2, 1.8), (2, 3.2)), ((45, 90.5), (1, 1.2), (1.4, 1.8)), ((52, 82), (0, 0.3), (0, 0.4)),
    ((104, 98), (-2, 1.8), (-2, 3.2)), ((99, 91), (-1, 1.2), (-1.4, 1.8)), ((91, 83), (0, 0.3), (0, 0.4)),
    # Chin and jaw
    ((72, 134), (0, -1), (0, 6)), ((72, 147), (0, 0), (0, 2)), ((55, 142), (0, 0), (0, 2)), ((89, 142), (0, 0), (0, 2)),
    ((42, 132), (0, 0), (0.5, 1.8)), ((102, 131), (0, 0), (-0.5, 1.8)),
    # Upper lids, lower lids
    ((40, 50.5), (0, 0.3), (0, -1)), ((46, 50), (0, 0.4), (0, -1.3)), ((52, 51.5), (0, 0.2), (0, -0.9)),
    ((92, 51.5), (0, 0.2), (0, -0.9)), ((98, 50.5), (0, 0.4), (0, -1.3)), ((104, 52), (0, 0.3), (0, -1)),
    ((46, 60), (0, 0.6), (0, 0.9)), ((98, 60), (0, 0.6), (0, 0.9)),
]
# What stays: nose, corners of the eyes, cheeks, sides of the face, hairline; then hair, neck and background
STILL = [(60, 90), (66, 92), (72, 93), (78, 92.5), (84, 91), (72, 75), (61, 70), (84, 70), (72, 50), (34, 56), (57, 57), (86, 58), (110, 56),
         (40, 70), (104, 70), (30, 82), (115, 82), (24, 100), (121, 100), (30, 122), (115, 120), (35, 35), (55, 32), (72, 32), (90, 33), (108, 37)]
BORDER = [(x, y) for x in range(0, 145, 24) for y in (0, 20, 157)] + [(x, y) for y in range(40, 160, 20) for x in (0, 12, 132, 144)]


def main():
    face = Face()
    pictures = {OUT / name / f"{i + 1:02}.png": picture for name in EXPRESSIONS for i, picture in enumerate(face.sequence(name))}
    if sys.argv[1:] == ["--check"]:
        wrong = [path for path, picture in pictures.items() if not (path.exists() and np.array_equal(Image.open(path), picture))]
        wrong += [path for name in EXPRESSIONS for path in (OUT / name).glob("*.png") if path not in pictures]
        sys.exit("not what this script makes: " + ", ".join(str(path) for path in wrong) if wrong else 0)
    for path, picture in pictures.items():
        path.parent.mkdir(exist_ok=True)
        Image.fromarray(picture).save(path, optimize=True)


def pose(expression):
    """What a face is drawn from, as arrays: outlines and landmarks, how bright its teeth and deep its folds are."""
    s = np.cos(np.linspace(np.pi, 0, 13))  # along the mouth, -1 and 1 in its corners
    flat, round_ = 1 - s * s, np.sqrt(1 - s * s)
    x = 72 + 25 * s
    upper, lower, upper_outer, lower_outer = (np.stack([x, np.interp(x, *np.transpose(line))], 1)
                                              for line in (UPPER_INNER, LOWER_INNER, UPPER_OUTER, LOWER_OUTER))
    upper_lip, lower_lip = upper_outer - upper, lower_outer - lower
    brows, face = np.array(sum(BROWS, []), float), np.array([at for at, *_ in FACE], float)
    teeth, teeth_y, folds = 1.0, 0.0, 1.0
    if expression == "neutral":
        upper = np.stack([72 + 19.5 * s, 106.3 + 0.2 * flat + 0.4 * flat**4], 1)
        lower = np.stack([72 + 19.5 * s, 106.3 + 1.4 * flat], 1)
        upper_lip, lower_lip = upper_lip * (0.6, 1.1), lower_lip * (0.6, 1)
        brows[:, 1] += 1.8
        face += [neutral for _, neutral, _ in FACE]
        folds = 0.35
    elif expression == "happy":  # a little more than the portrait
        upper += np.stack([2 * s, -0.8 * s * s], 1)
        lower += np.stack([2 * s, 0.7 * flat - 0.8 * s * s], 1)
        brows[:, 1] -= 0.8
    elif expression == "surprise":
        upper = np.stack([72 + 14 * s, 113 - 8 * round_], 1)
        lower = np.stack([72 + 14 * s, 113 + 12.5 * round_], 1)
        upper_lip, lower_lip = upper_lip * (0.5, 0.9), lower_lip * (0.8, 1)
        brows[:, 1] -= 5.8 * np.interp(brows[:, 0], [29, 39, 57, 87, 104, 115], [0.75, 1, 0.8, 0.8, 1, 0.7])
        face += [surprise for *_, surprise in FACE]
        teeth, teeth_y, folds = 0.6, -3.5, 0.35  # the upper lip hides more of them
    return {"upper": upper, "lower": lower, "upper_outer": upper + upper_lip, "lower_outer": lower + lower_lip,
            "brows": brows, "face": face, "teeth": teeth, "teeth_y": teeth_y, "folds": folds}


class Face:
    """The portrait, upright and taken apart into skin, brows, folds and teeth."""

    def __init__(self):
        self.x, self.y = np.meshgrid(*((np.arange(n * SCALE) + 0.5) / SCALE - 0.5 for n in (WIDTH, HEIGHT)))
        turn = (PORTRAIT_EYES[1] - PORTRAIT_EYES[0]) / (EYES[1] - EYES[0])
        at = PORTRAIT_EYES[0] + turn * (self.x + 1j * self.y - EYES[0])
        green = data.astronaut()[:, :, 1] / 255.0  # in which lips and brows are darkest
        grey = ndimage.map_coordinates(green, [at.imag, at.real], order=3, mode="nearest").clip(0, 1)
        grey = 255 * (0.6 * grey + 0.4 * exposure.equalize_adapthist(grey, kernel_size=(HEIGHT, WIDTH), clip_limit=0.01))

        self.portrait = pose("portrait")
        opening = self.between("upper", "lower", self.portrait)
        lips = (self.between("upper_outer", "lower_outer", self.portrait) - opening).clip(0, 1)
        self.teeth = DARK + (grey - DARK) * opening
        skin = grey + (DARK - grey) * opening
        # Once the lip moves, its highlight would look like a drop
        shine = skin - ndimage.gaussian_filter(ndimage.grey_opening(skin, 11 * SCALE), SCALE)
        skin -= shine.clip(0, None) * self.near([SHINE], 5) * (1 - opening)
        # Brows and folds, thin and dark, are lifted off, to be laid on again where they belong
        thin = (ndimage.gaussian_filter(ndimage.grey_closing(grey, 9 * SCALE), SCALE) - grey).clip(0, None)
        self.brows, self.folds = thin * self.near(BROWS, 4), thin * self.near(FOLDS, 4)
        self.skin = skin * (1 - 0.25 * lips) + self.brows + self.folds

    def near(self, lines, distance):
        """1 within half the distance of the lines, 0 from the distance on."""
        points = [np.add(a, t * np.subtract(b, a)) for line in lines for a, b in zip(line, line[1:]) for t in np.linspace(0, 1, 20)]
        nearest = np.min([np.hypot(self.x - x, self.y - y) for x, y in points], axis=0)
        return np.clip(2 - 2 * nearest / distance, 0, 1)

    def between(self, upper, lower, pose):
        """How much of each pixel is between two outlines of the mouth, with soft edges."""
        above, below = (np.interp(self.x, *pose[name].T) for name in (upper, lower))
        inside = np.clip((self.y - above) * SCALE + 0.5, 0, 1) * np.clip((below - self.y) * SCALE + 0.5, 0, 1)
        inside[(self.x <= pose["upper"][0, 0]) | (self.x >= pose["upper"][-1, 0])] = 0
        return ndimage.gaussian_filter(inside, 0.4 * SCALE)

    def warp(self, layer, pose, names, still):
        """Moves the named landmarks of a layer from where the portrait has them, and what is around them smoothly along."""
        # Outlines share the mouth's corners, of which the spline wants one
        at, to = (np.concatenate([p[name][1:-1] if "outer" in name else p[name] for name in names] + [still]) for p in (self.portrait, pose))
        x, y = RBFInterpolator(to, at - to, kernel="thin_plate_spline")(np.stack([self.x.ravel(), self.y.ravel()], 1)).T
        at = [(self.y + y.reshape(self.y.shape) + 0.5) * SCALE - 0.5, (self.x + x.reshape(self.x.shape) + 0.5) * SCALE - 0.5]
        return ndimage.map_coordinates(layer, at, order=1, mode="nearest")

    def draw(self, pose):
        # The spline would pull lips that part into each other, so each side of the mouth has its own
        skin = self.skin - pose["folds"] * self.folds
        above = self.warp(skin, pose, ["upper", "upper_outer", "face"], STILL + BORDER)
        below = self.warp(skin, pose, ["lower", "lower_outer", "face"], STILL + BORDER)
        upper, lower = (np.interp(self.x, *pose[name].T) for name in ("upper", "lower"))
        picture = above + (below - above) * np.clip(0.5 + (self.y - (upper + lower) / 2) / 2, 0, 1)
        # The lips shade the teeth, which move with the skull, and the tongue
        opening = self.between("upper", "lower", pose)
        light = (2 * ndimage.gaussian_filter(opening, 1.5 * SCALE) - 0.8).clip(0, 1)
        teeth = ndimage.shift(self.teeth, (pose["teeth_y"] * SCALE, 0), order=1, mode="nearest") - DARK
        tongue = 30 * np.clip(1 - (lower - self.y) / 8, 0, 1) * np.clip((lower - upper) / 8 - 1, 0, 1)
        picture += (DARK + light * (pose["teeth"] * teeth + tongue) - picture) * opening
        picture -= 1.7 * self.warp(self.brows, pose, ["brows"], BORDER)  # over 1, as hers are faint
        small = picture.reshape(HEIGHT, SCALE, WIDTH, SCALE).mean((1, 3))
        return np.rint(small).clip(0, 255).astype(np.uint8)

    def sequence(self, expression):
        start, end = pose("neutral"), pose(expression)
        for t in np.linspace(0, 1, FRAMES):
            t = 0.5 * t + 0.5 * t * t * (3 - 2 * t)  # starts and ends softly, but not so softly that a motion template misses it
            yield self.draw({name: start[name] + t * (end[name] - start[name]) for name in start})


if __name__ == "__main__":
    main()
