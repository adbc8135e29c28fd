"""``python -m prf`` among other programs: pipes that close, signals, terminals, odd names.

All as the command ``prf`` does it: with the signal's own end where nothing is to be saved (a shell calls
that 130), and with exit code 130 where something is.
"""

import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from command import PRF
from pictures import natural
from skimage.io import imsave
from terminal import PATIENCE_S, Terminal, wait_until


@pytest.fixture(autouse=True)
def ctrl_c() -> Iterator[None]:
    """Ctrl-C has its meaning, also where these tests run in the background of a script, whose children ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    imsave(tmp_path / "goal.png", natural(40, 53), check_contrast=False)
    return tmp_path


@pytest.mark.parametrize(
    "arguments",
    [["--help"], ["worlds"], ["score", "goal.png", "goal.png", "goal.png"], ["completions", "zsh"]],
)
def test_a_closed_pipe_ends_quietly(folder: Path, arguments: list[str]) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    ended = subprocess.run([*PRF, *arguments], cwd=folder, stdout=writer, stderr=subprocess.PIPE)
    os.close(writer)
    assert (ended.returncode, ended.stderr) == (0, b"")


@pytest.mark.skipif(sys.platform == "darwin", reason="its file systems have no such names")
def test_a_name_need_not_be_text(folder: Path) -> None:
    name = os.fsdecode(b"\xff\xfe.png")
    (folder / "goal.png").rename(folder / name)
    ended = subprocess.run([*PRF, "score", name, name], cwd=folder, capture_output=True)
    assert (ended.returncode, ended.stderr) == (0, b"")
    assert ended.stdout.endswith(b".png: reward 1.000000, distance 0.000000\n")


@pytest.fixture
def endless(folder: Path) -> Iterator[list[str]]:
    """A command that scores a video which takes until there is a file `stop`. Once it is about it, there is
    a file `begun`."""
    (folder / "endless.mp4").write_bytes(bytes(64))
    player = folder / "bin/ffmpeg"
    player.parent.mkdir()
    player.write_text("#!/bin/sh\n: >begun\nuntil [ -e stop ]; do sleep 0.02; done\nexit 1\n")
    player.chmod(0o755)
    yield [*PRF, "score", "goal.png", "endless.mp4"]
    (folder / "stop").touch()


def interrupt(command: list[str], folder: Path, interrupted: Callable[[], None]) -> tuple[int, str]:
    """Presses Ctrl-C, so to speak, once `command` is about it; returns its end and what it said."""
    environment = os.environ | {"PATH": f"{folder / 'bin'}:{os.environ['PATH']}"}
    with subprocess.Popen(
        command, cwd=folder, env=environment, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        try:
            wait_until((folder / "begun").exists, "the begin")
            os.killpg(process.pid, signal.SIGINT)
            interrupted()
            _, told = process.communicate(timeout=PATIENCE_S)
        finally:
            process.kill()
        return process.returncode, told


def test_ctrl_c_ends_a_computation(folder: Path, endless: list[str]) -> None:
    assert interrupt(endless, folder, lambda: None) == (-signal.SIGINT, "")


def test_ctrl_c_is_ignored_where_it_was(folder: Path, endless: list[str]) -> None:
    ignoring = ["sh", "-c", "trap '' INT; exec \"$@\"", "sh", *endless]
    code, told = interrupt(ignoring, folder, (folder / "stop").touch)
    assert code == 1
    assert "error: no frame could be scored" in told


@pytest.mark.parametrize("how", ["key", "signal"])
def test_ctrl_c_ends_a_game_and_saves_it(folder: Path, how: str) -> None:
    with Terminal([*PRF, "play", "flappy", "--fps", "50", "--frames", "frames"], folder) as terminal:
        terminal.wait_for(b"any key begins")
        terminal.press(b" ")
        terminal.wait_for(b"step 1/")
        if how == "key":
            terminal.press(b"\x03")
        else:
            terminal.process.send_signal(signal.SIGINT)
        terminal.wait_for(b"frames into frames")
        terminal.wait_for(b"played by you")
        assert terminal.process.wait(PATIENCE_S) == 130
    assert (folder / "frames/0001.png").is_file()
