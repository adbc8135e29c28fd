"""The examples of the documentation work."""

import doctest
from pathlib import Path
from types import ModuleType

import pytest

import prf.wrappers.single

DOCS = Path(__file__).parents[3] / "docs"


def test_the_page_about_python() -> None:
    page = doctest.testfile(str(DOCS / "python.md"), module_relative=False)
    assert page.attempted > 10
    assert page.failed == 0


@pytest.mark.parametrize("module", [prf.wrappers.single])
def test_docstrings(module: ModuleType) -> None:
    examples = doctest.testmod(module)
    assert examples.attempted > 0
    assert examples.failed == 0
