"""A pendulum learns to swing up and to stay up, from one picture of it standing up.

    pip install "prf-py[gymnasium]" "gymnasium[classic-control]" stable-baselines3
    python pendulum_from_a_picture.py --seed 1

Gymnasium's Pendulum-v1 has a reward of its own. The agent never sees it: `PerceptualReward` puts how much the rendered frame
looks like the picture in its place. The environment's own reward only says, in the end, how well that went.
"""

import argparse
import json
from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray
from stable_baselines3 import SAC

import prf
from prf.wrappers import PerceptualReward

SIZE = (84, 84)
Observation = NDArray[np.float32]
Env = gym.Env[Observation, NDArray[np.float32]]


def make_env() -> Env:
    return gym.make("Pendulum-v1", render_mode="rgb_array")


def picture_of(angle: float) -> NDArray[np.uint8]:
    """What the pendulum looks like at this angle from upright, in radians: grey, 84 by 84 pixels."""
    env = make_env()
    env.reset(seed=0)
    world: Any = env.unwrapped
    world.state, world.last_u = np.array([angle, 0.0]), None
    frame: Any = env.render()
    env.close()
    return prf.to_grey(frame, size=SIZE)


def goal() -> prf.DirectGoal:
    """Upright. Cells of a quarter of the picture look past details: the reward rises from far away."""
    return prf.DirectGoal(picture_of(0.0), cell=0.25)


def make_task() -> Env:
    """The pendulum with how much it looks like the picture as its reward."""
    return PerceptualReward(make_env(), goal(), size=SIZE)


def own_returns(act: Callable[[Observation], NDArray[np.float32]], episodes: int) -> list[float]:
    """What the environment's own reward sums up to in each of some episodes: 0 at best, about -1,200 for chance."""
    env = make_env()
    returns = []
    for episode in range(episodes):
        observation, _ = env.reset(seed=1_000 + episode)
        total, over = 0.0, False
        while not over:
            observation, reward, terminated, truncated, _ = env.step(act(observation))
            total, over = total + float(reward), terminated or truncated
        returns.append(total)
    env.close()
    return returns


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--steps", type=int, default=12_000)
    parser.add_argument("--episodes", type=int, default=20, help="evaluated at the end")
    args = parser.parse_args()

    rng = np.random.default_rng(args.seed)
    chance = own_returns(lambda _: rng.uniform(-2, 2, 1).astype(np.float32), args.episodes)
    model = SAC(
        "MlpPolicy",
        make_task(),
        learning_rate=1e-3,
        learning_starts=min(1_000, args.steps // 2),
        policy_kwargs={"net_arch": [64, 64]},
        seed=args.seed,
    )
    model.learn(args.steps)
    learned = own_returns(lambda observation: model.predict(observation, deterministic=True)[0], args.episodes)
    print(
        json.dumps(
            {
                "example": "pendulum_from_a_picture",
                "seed": args.seed,
                "steps": args.steps,
                "random_mean": np.mean(chance),
                "random_std": np.std(chance),
                "mean": np.mean(learned),
                "std": np.std(learned),
            }
        )
    )


if __name__ == "__main__":
    main()
