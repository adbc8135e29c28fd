"""A terminal with a program in it."""

import fcntl
import os
import pty
import struct
import subprocess
import termios
import time
from collections.abc import Callable
from pathlib import Path
from types import TracebackType

# Longer than anything takes on a busy machine.
PATIENCE_S = 60


def wait_until(is_so: Callable[[], bool], what: str) -> None:
    end = time.monotonic() + PATIENCE_S
    while not is_so():
        assert time.monotonic() < end, f"{what} never came"
        time.sleep(0.01)


class Terminal:
    """Runs ``command`` in ``folder`` as its only program, which is ended with it."""

    def __init__(self, command: list[str], folder: Path) -> None:
        self._end, programs_end = pty.openpty()
        rows, columns = 24, 80
        fcntl.ioctl(self._end, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))
        os.set_blocking(self._end, False)
        self._said = b""
        self.process = subprocess.Popen(
            command,
            cwd=folder,
            stdin=programs_end,
            stdout=programs_end,
            stderr=programs_end,
            start_new_session=True,
        )
        os.close(programs_end)

    def __enter__(self) -> "Terminal":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self._end)

    def press(self, keys: bytes) -> None:
        os.write(self._end, keys)

    def wait_for(self, words: bytes) -> None:
        wait_until(lambda: words in self._listen(), words.decode())

    def _listen(self) -> bytes:
        """All that the program has written."""
        try:
            self._said += os.read(self._end, 1 << 16)
        except OSError:
            pass  # there is nothing yet, or the program has ended
        return self._said
