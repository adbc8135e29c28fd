"""Modules that have no types, or had none in an older version."""

from importlib import import_module
from typing import Any

numpy_ma: Any = import_module("numpy.ma")
skimage_feature: Any = import_module("skimage.feature")
