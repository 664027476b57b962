"""``mmrs`` and ``mmrs-gen`` without their start: each call is a fork of one process that has imported them.

Half of the time of most commands is that of their imports. A call has the caller's folder, environment, files
and signals, and ends as a process of its own does.
"""

from __future__ import annotations

import atexit
import os
import pkgutil
import signal
import socket
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path

PROGRAMS = ("mmrs", "mmrs-gen")
CALLER = """#!{python} -IS
import os, signal, socket, sys
line = socket.socket(socket.AF_UNIX)
line.connect({address!r})
variables = (f"{{name}}={{value}}" for name, value in os.environ.items())
said = [{program!r}, os.getcwd(), str(len(sys.argv) - 1), *sys.argv[1:], *variables]
text = "\\0".join(said).encode("utf-8", "surrogateescape")
socket.send_fds(line, [len(text).to_bytes(4, "big")], [0, 1, 2])
line.sendall(text)
pid = int.from_bytes(line.recv(4), "big")
for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    signal.signal(each, lambda number, frame: os.kill(pid, number))
code = line.recv(1)
sys.exit(code[0] if code else 137)
"""


@contextmanager
def warm_commands(folder: Path, environment: Mapping[str, str]) -> Iterator[Path]:
    """Yield a folder of programs for PATH, to be called while this lasts."""
    address, programs = folder / "calls", folder / "bin"
    programs.mkdir()
    for program in PROGRAMS:
        text = CALLER.format(python=sys.executable, address=str(address), program=program)
        (programs / program).write_text(text)
        (programs / program).chmod(0o755)
    with socket.socket(socket.AF_UNIX) as listening:
        listening.bind(str(address))
        listening.listen()
        fd = listening.fileno()
        server = subprocess.Popen(
            [sys.executable, __file__, str(fd)], pass_fds=[fd], env=environment, stdin=subprocess.DEVNULL
        )
        try:
            yield programs
        finally:
            server.kill()
            server.wait()


def import_everything() -> None:
    """Import the core and what it is used with, so that no call has to."""
    import mmrs_core
    import mmrs_runtime
    from mmrs_core.plugins import load_plugins

    for package in (mmrs_core, mmrs_runtime):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not module.name.endswith(("__main__", ".stubs.write")):
                __import__(module.name)
    load_plugins()


def bury(number: int, frame: object) -> None:
    """Take note of calls that have ended, so that their time is counted."""
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


def called(listening: socket.socket) -> tuple[socket.socket, list[str]]:
    """Wait for calls, each in a fork, which alone returns: with the line to its caller, and what is said."""
    while True:
        line, _ = listening.accept()
        if os.fork() == 0:
            break
        line.close()
    listening.close()
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    size, fds, _, _ = socket.recv_fds(line, 4, 3)
    for number, fd in enumerate(fds):
        os.dup2(fd, number)
        os.close(fd)
    text = b""
    while len(text) < int.from_bytes(size, "big"):
        text += line.recv(1 << 16)
    line.sendall(os.getpid().to_bytes(4, "big"))
    return line, text.decode("utf-8", "surrogateescape").split("\0")


def serve(listening: socket.socket) -> None:
    """Take calls; in the fork of one, carry it out and exit."""
    signal.signal(signal.SIGCHLD, bury)
    line, (program, folder, count, *rest) = called(listening)
    code = 70
    atexit.register(lambda: line.sendall(bytes((code,))))
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(each.split("=", 1) for each in rest[int(count) :])
    sys.argv = [program, *rest[: int(count)]]
    from mmrs_core.cli import main, main_generate

    try:
        main() if program == "mmrs" else main_generate()
    except SystemExit as ended:
        code = ended.code if isinstance(ended.code, int) else int(ended.code is not None)
        raise


if __name__ == "__main__":
    sys.path.pop(0)
    import_everything()
    serve(socket.socket(fileno=int(sys.argv[1])))
