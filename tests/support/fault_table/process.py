"""A process that flies robots: what it says, how it is told to end, and how it ends."""

import subprocess
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import IO

from warm_python import python


class Process:
    """A program of ours as a process.

    Attributes:
        said: what it has said so far, by lines.
    """

    def __init__(self, arguments: Sequence[str], folder: Path, into: IO[str] | None = None) -> None:
        """Start it in a folder; `into`: where it says what it says; None: here."""
        self.said: list[str] = []
        self._popen = subprocess.Popen(
            [python(), "-W", "error", *arguments],
            cwd=folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=into or subprocess.PIPE,
            text=True,
        )
        self._reader = threading.Thread(target=self._listen, daemon=True)
        self._reader.start()

    def signal(self, number: int) -> None:
        """Send it a signal."""
        self._popen.send_signal(number)

    def running(self) -> bool:
        """Return whether it has not ended."""
        return self._popen.poll() is None

    def end(self, seconds: float = 60.0) -> int | None:
        """Wait for its end; return its exit code, None if it has not ended in that time."""
        try:
            code = self._popen.wait(seconds)
        except subprocess.TimeoutExpired:
            return None
        self._reader.join()
        return code

    def close(self) -> None:
        """Make sure that it has ended."""
        if self.running():
            self._popen.kill()
        self._popen.wait()
        self._reader.join()

    def _listen(self) -> None:
        if self._popen.stderr is None:
            return
        with self._popen.stderr:
            for line in self._popen.stderr:
                self.said.append(line.rstrip("\n"))
