"""Windows are opened where nobody sees them."""

import os
import warnings

os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # pygame uses what setuptools has deprecated
    import pygame  # noqa: F401
