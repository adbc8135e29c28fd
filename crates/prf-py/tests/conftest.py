"""Windows are opened where nobody sees them."""

import os
import warnings
from importlib import import_module
from importlib.util import find_spec

os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["PYGAME_HIDE_SUPPORT_PROMPT"] = "1"
# Most tests open none, and run without it.
if find_spec("pygame"):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # pygame uses what setuptools has deprecated
        import_module("pygame")
