"""Makes Gymnasium know the environments, which are imported when the first one is made."""

from gymnasium.envs.registration import register, registry  # pyright: ignore[reportUnknownVariableType]

from prf._native import preset_limit_steps

IDS = {
    "PRF/Breakout-v0": ("Breakout", "breakout"),
    "PRF/FlappyBird-v0": ("FlappyBird", "flappy"),
    "PRF/KobianFace-v0": ("KobianFace", "kobian-happy-kprf"),
}
"""How the names of the classes begin, and the preset that says after how many steps an episode is truncated."""


def register_envs() -> None:
    """Registers what is not registered yet."""
    for id, (name, preset) in IDS.items():
        if id not in registry:
            register(
                id,
                entry_point=f"prf.envs:{name}Env",
                vector_entry_point=f"prf.envs:{name}VectorEnv",
                max_episode_steps=preset_limit_steps(preset),
            )
