"""What the native module asks of the machine and the interpreter that load it."""

import json
import subprocess
import sys

import pytest
from elftools.elf.dynamic import DynamicSection
from elftools.elf.elffile import ELFFile

from prf import _native

# The C library in its parts, and what unwinds a panic: every Linux that the wheels are for has them.
EVERYWHERE = {
    "ld-linux-aarch64.so.1",
    "ld-linux-x86-64.so.2",
    "libc.so.6",
    "libdl.so.2",
    "libgcc_s.so.1",
    "libm.so.6",
    "libpthread.so.0",
    "librt.so.1",
}


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have another format")
def test_no_library_need_be_there_libtorch_least_of_all() -> None:
    with open(_native.__file__, "rb") as file:
        dynamic = ELFFile(file).get_section_by_name(".dynamic")
        assert isinstance(dynamic, DynamicSection)
        needed = {getattr(tag, "needed") for tag in dynamic.iter_tags("DT_NEEDED")}
        assert list(dynamic.iter_tags("DT_RUNPATH")) + list(dynamic.iter_tags("DT_RPATH")) == []
    assert "libc.so.6" in needed
    assert needed <= EVERYWHERE


def test_every_python_from_3_10_has_all_that_is_used_of_it() -> None:
    audit = [sys.executable, "-m", "abi3audit", "--strict", "--report", "--assume-minimum-abi3", "3.10"]
    ended = subprocess.run([*audit, _native.__file__], capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    [spec] = json.loads(ended.stdout)["specs"].values()
    result = spec["object"]["result"]
    assert result["is_abi3"]
    assert result["is_abi3_baseline_compatible"], result
