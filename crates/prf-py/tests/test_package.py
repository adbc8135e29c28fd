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
    python("-m", "mypy.stubtest", "prf._native", "--mypy-config-file", "pyproject.toml")


NATIVE = sorted(set(prf.__all__) - {"__version__", "Rect", "Match", "Score"})


@pytest.mark.parametrize("name", NATIVE)
def test_the_examples_of_functions_and_classes_work(name: str) -> None:
    example = doctest.DocTestParser().get_doctest(getattr(prf, name).__doc__, {}, name, None, None)
    assert example.examples
    assert doctest.DocTestRunner().run(example).failed == 0


@pytest.mark.parametrize("name", NATIVE)
def test_everything_public_has_a_docstring(name: str) -> None:
    item = getattr(prf, name)
    members = (
        [getattr(item, member) for member in vars(item) if not member.startswith("_")]
        if isinstance(item, type)
        else []
    )
    for documented in [item, *members]:
        assert documented.__doc__
        assert all(len(line) <= 120 for line in documented.__doc__.splitlines())


def test_the_other_examples_work() -> None:
    assert doctest.testmod(prf).failed == 0
    readme = doctest.testfile(str(PACKAGE / "README.md"), module_relative=False)
    assert readme.attempted > 0
    assert readme.failed == 0
