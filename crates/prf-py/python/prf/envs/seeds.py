"""Which episode of a world a seed stands for."""

import numpy as np

EPISODES = 2**64
"""A world has so many."""


def episode_of(seed: int) -> int:
    """The episode of this seed: the one with the same number."""
    return seed % EPISODES


def draw_seed(generator: np.random.Generator) -> int:
    """Any episode."""
    # A fifth of the time that generator.integers takes, for the same 64 bits.
    return episode_of(generator.bit_generator.random_raw())
