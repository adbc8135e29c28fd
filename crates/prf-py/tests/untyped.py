"""Modules that have no types."""

from importlib import import_module
from typing import Any

skimage_feature: Any = import_module("skimage.feature")
