"""A reward from pictures for any Gymnasium environment.

:class:`PerceptualReward` wraps one environment, :class:`prf.wrappers.vector.PerceptualReward` a vector environment.
"""

from prf._extras import require_gymnasium

require_gymnasium("prf.wrappers")

from prf.wrappers import vector  # noqa: E402
from prf.wrappers.single import PerceptualReward  # noqa: E402

__all__ = ["PerceptualReward", "vector"]
