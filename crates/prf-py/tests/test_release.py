"""The workflow that publishes wheels, as far as it can be checked without running it."""

import re
import subprocess
import sys
from importlib.metadata import packages_distributions, requires
from pathlib import Path
from typing import Any

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name
from ruamel.yaml import YAML

PACKAGE = Path(__file__).parent.parent
ROOT = PACKAGE.parent.parent
FILE = ROOT / ".github/workflows/release.yml"


def jobs() -> Any:
    return YAML(typ="safe").load(FILE)["jobs"]


def the_one(pattern: str, file: Path) -> str:
    [found] = re.findall(pattern, file.read_text(encoding="utf-8"), re.MULTILINE)
    return str(found)


def test_it_is_a_workflow() -> None:
    check = [sys.executable, "-m", "check_jsonschema", "--builtin-schema", "vendor.github-workflows"]
    ended = subprocess.run([*check, str(FILE)], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr


def test_it_builds_with_what_the_tests_build_with() -> None:
    [maturin] = [step["with"] for step in jobs()["build"]["steps"] if "maturin" in step.get("uses", "")]
    assert maturin["maturin-version"] == "v" + the_one("^maturin==(.*)$", PACKAGE / "requirements-test.txt")
    assert maturin["rust-toolchain"] == the_one('^rust-version = "(.*)"$', ROOT / "Cargo.toml")


def test_every_wheel_is_tried_before_it_is_published() -> None:
    built = [build["platform"] for build in jobs()["build"]["strategy"]["matrix"]["include"]]
    tried = jobs()["try"]["strategy"]["matrix"]
    assert [platform["name"] for platform in tried["platform"]] == built
    assert tried["python"][0] == the_one('^requires-python = ">=(.*)"$', PACKAGE / "pyproject.toml")
    assert jobs()["publish"]["needs"] == "try"


def test_only_a_pushed_tag_is_published() -> None:
    condition = jobs()["publish"]["if"]
    assert "github.event_name == 'push'" in condition and "github.ref_type == 'tag'" in condition


def test_the_tests_that_try_a_wheel_need_no_more_than_is_installed_for_them() -> None:
    [run] = [step["run"] for step in jobs()["try"]["steps"] if step.get("name") == "Tests"]
    [installed] = re.findall(r"--constraint \S+ (.*)$", run, re.MULTILINE)
    named = re.findall(r"tests/\S+\.py", run)
    assert named
    there = with_what_they_need(["prf-py", *installed.split()])
    missing = {
        module
        for module, names in packages_distributions().items()
        if not there.intersection(map(canonicalize_name, names))
    }
    assert "pygame" in missing
    code = (
        "import sys\n"
        f"sys.modules.update(dict.fromkeys({sorted(missing - {'_pytest', 'py'})!r}))\n"
        "import pytest\n"
        f"sys.exit(pytest.main(['--collect-only', '-q', '-p', 'no:cacheprovider', *{named!r}]))\n"
    )
    ended = subprocess.run([sys.executable, "-c", code], cwd=PACKAGE, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stdout + ended.stderr


def with_what_they_need(names: list[str]) -> set[str]:
    """These distributions and those that they require, without extras."""
    found: set[str] = set()
    while names:
        name = canonicalize_name(names.pop())
        if name not in found:
            found.add(name)
            needed = map(Requirement, requires(name) or [])
            names += [each.name for each in needed if each.marker is None or each.marker.evaluate({"extra": ""})]
    return found
