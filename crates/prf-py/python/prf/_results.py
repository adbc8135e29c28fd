"""Results with names."""

from typing import NamedTuple


class Rect(NamedTuple):
    """A part of a picture, in pixels: columns ``x`` to ``x + width`` of rows ``y`` to ``y + height``, ends excluded.

    The order is OpenCV's: ``image[y : y + height, x : x + width]`` is the part itself.
    """

    x: int
    """Left column."""
    y: int
    """Top row."""
    width: int
    """Columns, at least 1."""
    height: int
    """Rows, at least 1."""


class Match(NamedTuple):
    """Where a goal was found in a frame, in pixels of the frame, and how well it fits there."""

    x: int
    """Left column."""
    y: int
    """Top row."""
    width: int
    """Columns, as many as the goal has."""
    height: int
    """Rows, as many as the goal has."""
    score: float
    """The correlation, at most 1: of "ccorr-normed" at least 0, of "ccoeff-normed" at least -1."""


class Score(NamedTuple):
    """How near a frame is to a goal."""

    reward: float
    """``exp(-distance)``, above 0 and at most 1; exactly 1 for the goal itself."""
    distance: float
    """At least 0; 0 for the goal itself."""
    match: Match | None
    """Which part of the frame was compared, for a :class:`WindowGoal`; otherwise None."""


for _class in (Rect, Match, Score):
    _class.__module__ = "prf"  # where users find them
