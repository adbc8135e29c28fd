"""What a wrapper is told about its goal."""

from typing import Literal, TypeAlias

from prf._native import DirectGoal, Goal, MotionGoal, WindowGoal
from prf.envs.options import GoalLike, choice

Descriptor: TypeAlias = Literal["direct", "window", "motion"]

CLASSES: dict[str, type[DirectGoal] | type[WindowGoal] | type[MotionGoal]] = {"direct": DirectGoal, "window": WindowGoal, "motion": MotionGoal}


def make_goal(goal: GoalLike, descriptor: Descriptor | None) -> Goal:
    """A goal with an episode of its own."""
    if descriptor is not None:
        choice("descriptor", descriptor, tuple(CLASSES))
    if not isinstance(goal, Goal):
        return CLASSES[descriptor or "direct"](goal)
    if descriptor is not None and not isinstance(goal, CLASSES[descriptor]):
        raise ValueError(f"descriptor: got {descriptor!r} with a {type(goal).__name__}, expected None or its own")
    return goal.copy()
