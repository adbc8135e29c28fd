"""Stable-Baselines3's DQN and PPO on the worlds of PRF, rewarded by how much a frame looks like a picture.

    pip install "prf-py[gymnasium]" stable-baselines3
    python sb3_worlds.py dqn PRF/Breakout-v0 --seed 1
    python sb3_worlds.py ppo PRF/KobianFace-v0 --seed 1

The frames have no axis for colours, and Stable-Baselines3's networks for pictures want one.
"""

import argparse
import json
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.wrappers import ReshapeObservation
from stable_baselines3 import DQN, PPO
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.env_util import make_vec_env
from stable_baselines3.common.vec_env import VecEnv

import prf  # noqa: F401: its import registers the environments


def make_env(name: str) -> gym.Env[Any, Any]:
    env = gym.make(name)
    height, width = env.observation_space.shape or ()
    return ReshapeObservation(env, (height, width, 1))


def make_model(algorithm: str, env: VecEnv, seed: int, steps: int) -> BaseAlgorithm:
    if algorithm == "ppo":
        rollout = min(128, max(2, steps // env.num_envs // 2))
        return PPO("CnnPolicy", env, n_steps=rollout, batch_size=min(256, rollout * env.num_envs), seed=seed)
    return DQN(
        "CnnPolicy",
        env,
        buffer_size=20_000,
        learning_starts=min(1_000, steps // 2),
        gradient_steps=env.num_envs,  # an update every four steps, however many environments there are
        exploration_fraction=0.5,
        target_update_interval=500,
        seed=seed,
    )


def evaluate(model: BaseAlgorithm | None, name: str, episodes: int, seed: int) -> tuple[list[float], list[float]]:
    """Sums of rewards, and scores at the end, of episodes by a model, or by chance."""
    env = make_env(name)
    env.action_space.seed(seed)
    returns, scores = [], []
    for episode in range(episodes):
        observation, _ = env.reset(seed=10_000 + episode)
        total, over, info = 0.0, False, dict[str, Any]()
        while not over:
            if model is None:
                action = env.action_space.sample()
            else:
                action = model.predict(observation, deterministic=True)[0].item()
            observation, reward, terminated, truncated, info = env.step(action)
            total, over = total + float(reward), terminated or truncated
        returns.append(total)
        scores.append(info["score"])
    env.close()
    return returns, scores


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("algorithm", choices=["dqn", "ppo"])
    parser.add_argument("env")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--steps", type=int, default=50_000)
    parser.add_argument("--episodes", type=int, default=20, help="evaluated at the end")
    args = parser.parse_args()

    env = make_vec_env(lambda: make_env(args.env), n_envs=8, seed=args.seed)
    model = make_model(args.algorithm, env, args.seed, args.steps)
    model.learn(args.steps)
    result: dict[str, Any] = {"algorithm": args.algorithm, "env": args.env, "seed": args.seed, "steps": args.steps}
    for who, player in {"random": None, "learned": model}.items():
        returns, scores = evaluate(player, args.env, args.episodes, args.seed)
        result |= {f"{who}_return": np.mean(returns), f"{who}_score": np.mean(scores), f"{who}_score_std": np.std(scores)}
    print(json.dumps(result))


if __name__ == "__main__":
    main()
