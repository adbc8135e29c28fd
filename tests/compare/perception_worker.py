"""The peers' side of `cargo xtask compare perception`: OpenCV's and scikit-image's way of each case.

    python perception_worker.py FOLDER

FOLDER holds cases.json and the pictures. Says its versions in one line of JSON, then answers each line that it reads
with one line of JSON: `time CASE PEER TURNS` with the calls made and their nanoseconds, `result CASE PEER FILE`, which
writes what the calls of one turn gave as little-endian 32-bit floats, with how many there are. A turn is one call
for each of the case's pictures. crates/prf-core/examples/perception_worker answers the same for prf.
"""

import gc
import json
import platform
import sys
import time
from pathlib import Path

import cv2
import numpy as np
import skimage

from peers import PEERS


def main():
    folder = Path(sys.argv[1])
    cv2.setNumThreads(1)
    cv2.ocl.setUseOpenCL(False)
    gc.disable()  # as timeit does
    cases = {case["name"]: case for case in json.loads((folder / "cases.json").read_text())}
    say({"versions": versions()})
    kept, running = None, None
    for line in sys.stdin:
        command, name, peer, argument = line.rstrip("\n").split(" ", 3)
        if command == "result":
            say(Running(folder, cases[name], peer).write_result(argument))
            continue
        if kept != (name, peer):
            kept, running = (name, peer), Running(folder, cases[name], peer)
            running.turn()  # memory and caches are those of a long run
        say(running.time_turns(int(argument)))


class Running:
    """A case with its pictures."""

    def __init__(self, folder, case, peer):
        self.frames = pictures(folder, case["frames"])
        self.job = PEERS[peer, case["work"]](case, lambda key: pictures(folder, case[key])[0])

    def turn(self):
        for frame in self.frames:
            self.job.call(frame)

    def time_turns(self, turns):
        start = time.perf_counter_ns()
        for _ in range(turns):
            self.turn()
        return {"calls": turns * len(self.frames), "ns": time.perf_counter_ns() - start}

    def write_result(self, file):
        outputs = []
        for frame in self.frames:
            self.job.call(frame)
            outputs.append(np.array(self.job.output(), np.float32).ravel())
        values = np.concatenate(outputs)
        values.astype("<f4").tofile(file)
        return {"values": len(values)}


def versions():
    build = "with IPP" if cv2.ipp.useIPP() else "without IPP"
    return {
        "OpenCV": f"{cv2.__version__} {build}",
        "scikit-image": skimage.__version__,
        "NumPy": np.__version__,
        "Python": platform.python_version(),
    }


def pictures(folder, spec):
    """[count, height, width]"""
    pixels = np.fromfile(folder / spec["file"], np.uint8)
    return list(pixels.reshape(spec["count"], spec["height"], spec["width"]))


def say(answer):
    print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
