"""A reward from pictures for any Gymnasium environment.

:class:`PerceptualReward` wraps one environment, :class:`prf.wrappers.vector.PerceptualReward` a vector environment.
"""

from prf._extras import require_gymnasium

require_gymnasium("prf.wrappers")

from prf.wrappers import vector
from prf.wrappers.single import PerceptualReward

__all__ = ["PerceptualReward", "vector"]
