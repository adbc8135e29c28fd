"""What comes with the package: version, types, docs."""

import doctest
import importlib.metadata
import subprocess
import sys
from pathlib import Path

import pytest

import prf

PACKAGE = Path(__file__).parent.parent


def test_the_version_is_the_package_s() -> None:
    assert prf.__version__ == importlib.metadata.version("prf-py")


def python(*arguments: str) -> None:
    run = subprocess.run([sys.executable, *arguments], cwd=PACKAGE, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout + run.stderr


def test_types_are_strict() -> None:
    python("-m", "mypy", "--strict", "--package", "prf")
    python("-m", "mypy", "--strict", "tests")


def test_the_stubs_say_what_is_there() -> None:
    python("-m", "mypy.stubtest", "prf", "--mypy-config-file", "pyproject.toml")


@pytest.mark.parametrize("name", ["hog", "reward", "distance"])
def test_the_examples_of_functions_work(name: str) -> None:
    function = getattr(prf, name)
    example = doctest.DocTestParser().get_doctest(function.__doc__, {}, name, None, None)
    assert example.examples
    assert doctest.DocTestRunner().run(example).failed == 0


def test_the_other_examples_work() -> None:
    assert doctest.testmod(prf).failed == 0
    readme = doctest.testfile(str(PACKAGE / "README.md"), module_relative=False)
    assert readme.attempted > 0
    assert readme.failed == 0
