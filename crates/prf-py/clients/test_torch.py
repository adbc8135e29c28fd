"""PyTorch in the same process: both bring native code, and neither may get into the other's way."""

import subprocess
import sys

import numpy as np
import pytest
import torch

import prf

GOAL = np.arange(48 * 48, dtype=np.uint8).reshape(48, 48)
FRAME = np.ascontiguousarray(GOAL.T)


def test_a_tensor_s_memory_is_a_picture() -> None:
    goal, frame = torch.from_numpy(GOAL), torch.from_numpy(FRAME)
    assert prf.reward(goal.numpy(), frame.numpy()) == prf.reward(GOAL, FRAME) < 1


@pytest.mark.parametrize("modules", ["torch, prf", "prf, torch"])
def test_the_order_of_imports_does_not_matter(modules: str) -> None:
    program = f"""
import numpy as np, {modules}
goal = np.arange(48 * 48, dtype=np.uint8).reshape(48, 48)
print(prf.reward(goal, np.ascontiguousarray(goal.T)))
print(torch.nn.functional.conv2d(torch.ones(1, 1, 64, 64), torch.ones(1, 1, 8, 8)).sum().item())
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    reward, total = map(float, ended.stdout.split())
    assert reward == prf.reward(GOAL, FRAME)
    assert total == 57 * 57 * 64
