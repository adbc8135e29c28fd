"""The workflow that publishes wheels, as far as it can be checked without running it."""

import re
import subprocess
import sys
from pathlib import Path
from typing import Any

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
    [tests] = [step["run"] for step in jobs()["try"]["steps"] if step.get("name") == "Tests"]
    named = re.findall(r"tests/\S+\.py", tests)
    assert named
    assert all((PACKAGE / name).is_file() for name in named)
