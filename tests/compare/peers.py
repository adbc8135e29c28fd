"""What is timed: each case's work as someone who knows OpenCV or scikit-image would write it in Python.

A job is made once, with all that can be prepared; `call` is the work and `output` is what the last call gave.
"""

import math

import cv2
import numpy as np
from skimage.feature import hog

METHODS = {"ccorr-normed": cv2.TM_CCORR_NORMED, "ccoeff-normed": cv2.TM_CCOEFF_NORMED}


def hog_descriptor(width, height, cell, block_cells):
    """9 unsigned bins, L2-Hys; without the gamma correction that is OpenCV's default."""
    block, stride = (block_cells * cell, block_cells * cell), (cell, cell)
    return cv2.HOGDescriptor((width, height), block, stride, (cell, cell), 9, 1, -1.0, 0, 0.2, False, 64, False)


class Job:
    def call(self, frame):
        raise NotImplementedError

    def output(self):
        raise NotImplementedError


class OpenCvHog(Job):
    def __init__(self, case, picture):
        params, frames = case["hog"], case["frames"]
        self.hog = hog_descriptor(frames["width"], frames["height"], params["cell"]["px"], params["block_cells"])

    def call(self, frame):
        self.features = self.hog.compute(frame)

    def output(self):
        return self.features


class ScikitImageHog(Job):
    def __init__(self, case, picture):
        params = case["hog"]
        self.cell, self.block = (params["cell"]["px"],) * 2, (params["block_cells"],) * 2

    def call(self, frame):
        self.features = hog(frame, 9, self.cell, self.block, "L2-Hys")

    def output(self):
        return self.features


class Scores(Job):
    def __init__(self, case, picture):
        self.template, self.method = picture("template"), METHODS[case["method"]]
        windows = [case["frames"][side] - case["template"][side] + 1 for side in ("height", "width")]
        self.map = np.empty(windows, np.float32)

    def call(self, frame):
        cv2.matchTemplate(frame, self.template, self.method, self.map)

    def output(self):
        return self.map


class Best(Scores):
    def call(self, frame):
        cv2.matchTemplate(frame, self.template, self.method, self.map)
        _, self.score, _, self.corner = cv2.minMaxLoc(self.map)

    def output(self):
        return [*self.corner, self.score]


class Motion(Job):
    def __init__(self, case, picture):
        params, frames = case["motion"], case["frames"]
        self.threshold, self.start, self.step = params["threshold"], params["tau_start"], params["tau_step"]
        self.duration = params["delta"]["duration"]
        shape = frames["height"], frames["width"]
        self.silhouette, self.history = np.empty(shape, np.uint8), np.zeros(shape, np.float32)
        self.reset()

    def reset(self):
        self.history.fill(0)
        self.before, self.iterations, self.tau = None, 0, 0.0

    def call(self, frame):
        if self.before is not None:
            self.tau = self.start + self.step * self.iterations
            cv2.absdiff(frame, self.before, self.silhouette)
            cv2.threshold(self.silhouette, self.threshold, 1, cv2.THRESH_BINARY, self.silhouette)
            cv2.motempl.updateMotionHistory(self.silhouette, self.history, self.tau, self.duration)
            self.iterations += 1
        self.before = frame

    def output(self):
        return self.history


class Comparison:
    """exp(-distance) of two templates' HOGs; the goal's are kept for every size."""

    def __init__(self, case, goal):
        self.cell, self.block_cells = case["hog"]["cell"], case["hog"]["block_cells"]
        self.goal, _ = crop(goal)
        self.goal_features, self.descriptors = {}, {}

    def reward(self, template):
        agent, self.box = crop(template)
        shape = max(agent.shape, self.goal.shape, key=lambda shape: (shape[0] * shape[1], shape[0]))
        features, blocks = self.features(agent, shape)
        if shape not in self.goal_features:
            self.goal_features[shape], _ = self.features(self.goal, shape)
        self.count = features.size
        return math.exp(-np.linalg.norm(features - self.goal_features[shape]) / math.sqrt(blocks))

    def features(self, picture, shape):
        height, width = shape
        if picture.shape != shape:
            picture = cv2.resize(picture, (width, height), interpolation=cv2.INTER_LINEAR)
        cell = self.cell["px"] if "px" in self.cell else max(1, int(self.cell["fraction"] * height))
        rows, columns = height // cell, width // cell
        if shape not in self.descriptors:
            self.descriptors[shape] = hog_descriptor(columns * cell, rows * cell, cell, self.block_cells)
        blocks = (rows - self.block_cells + 1) * (columns - self.block_cells + 1)
        return self.descriptors[shape].compute(picture[: rows * cell, : columns * cell]), blocks


def crop(picture):
    """What is not black and where that is; a black picture stays whole."""
    x, y, width, height = cv2.boundingRect(picture)
    if width == 0:
        height, width = picture.shape
    return picture[y : y + height, x : x + width], (x, y, width, height)


class DirectReward(Job):
    def __init__(self, case, picture):
        self.comparison = Comparison(case, picture("goal"))

    def call(self, frame):
        self.corner = 0, 0
        self.reward = self.comparison.reward(frame)

    def output(self):
        (left, top), (x, y, width, height) = self.corner, self.comparison.box
        return [left + x, top + y, width, height, self.comparison.count]


class WindowReward(DirectReward):
    def __init__(self, case, picture):
        super().__init__(case, picture)
        self.goal = picture("goal")

    def call(self, frame):
        scores = cv2.matchTemplate(frame, self.goal, cv2.TM_CCORR_NORMED)
        self.corner = cv2.minMaxLoc(scores)[3]
        (x, y), (height, width) = self.corner, self.goal.shape
        self.reward = self.comparison.reward(frame[y : y + height, x : x + width])


class MotionReward(DirectReward):
    """Each turn is an episode: its first picture begins a new motion template."""

    def __init__(self, case, picture):
        super().__init__(case, picture)
        self.motion, self.episode, self.step = Motion(case, picture), case["frames"]["count"], 0

    def call(self, frame):
        if self.step % self.episode == 0:
            self.motion.reset()
        self.step += 1
        self.motion.call(frame)
        scale = 255 / self.motion.tau if self.motion.tau > 0 else 0
        self.corner = 0, 0
        self.reward = self.comparison.reward(cv2.convertScaleAbs(self.motion.history, alpha=scale))


REWARDS = {"direct": DirectReward, "window": WindowReward, "motion": MotionReward}

PEERS = {
    ("opencv", "hog"): OpenCvHog,
    ("scikit-image", "hog"): ScikitImageHog,
    ("opencv", "scores"): Scores,
    ("opencv", "best"): Best,
    ("opencv", "motion"): Motion,
    ("opencv", "reward"): lambda case, picture: REWARDS[case["descriptor"]](case, picture),
}
