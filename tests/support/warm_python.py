"""A Python that has imported everything already: for processes whose start is not what is tested.

Most of the time of most commands and controllers is that of their imports. `python` gives a program to be
called as any Python is; each call is a fork of one process that has imported them. It has the folder,
environment, files and signals of its caller, ends as a process of its own does, and is killed when its caller
is. `FREEZE` and `THAW` do to it what SIGSTOP and SIGCONT would do.
"""

import atexit
import contextlib
import gc
import io
import os
import pkgutil
import runpy
import selectors
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
from functools import cache
from importlib.metadata import EntryPoint, entry_points
from pathlib import Path

import shared

PROGRAMS = {
    "python": [],
    "mmrs": ["-c", "from mmrs_core.cli import main; main()"],
    "mmrs-gen": ["-c", "from mmrs_core.cli import main_generate; main_generate()"],
}
FREEZE, THAW = signal.SIGUSR1, signal.SIGUSR2
CALLER = """#!{python} -IS
import os, signal, socket, sys
line = socket.socket(socket.AF_UNIX)
line.connect({address!r})
variables = [f"{{name}}={{value}}" for name, value in os.environ.items()]
said = [sys.argv[0], os.getcwd(), str(len(sys.argv) - 1 + {added}), *{words!r}, *sys.argv[1:], *variables]
text = "\\0".join(said).encode("utf-8", "surrogateescape")
socket.send_fds(line, [len(text).to_bytes(4, "big")], [0, 1, 2])
line.sendall(text)
pid = int.from_bytes(line.recv(4), "big")
for each in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
    if signal.getsignal(each) != signal.SIG_IGN:
        signal.signal(each, lambda number, frame: os.kill(pid, number))
signal.signal({freeze}, lambda number, frame: os.kill(pid, signal.SIGSTOP))
signal.signal({thaw}, lambda number, frame: os.kill(pid, signal.SIGCONT))
status = int.from_bytes(line.recv(4), "big")
if os.WIFSIGNALED(status):
    number = os.WTERMSIG(status)
    if number != signal.SIGKILL:
        signal.signal(number, signal.SIG_DFL)
    os.kill(os.getpid(), number)
sys.exit(os.waitstatus_to_exitcode(status))
"""


def python() -> str:
    """Return the path of a Python that starts in no time, and understands -c, -m, -W and -u."""
    return str(programs() / "python")


@cache
def programs() -> Path:
    """Return a folder with that Python, ``mmrs`` and ``mmrs-gen``, which work until this process ends."""
    folder = shared.made_once("warm", _write_programs)
    with shared.alone("warm"):
        line = socket.socket(socket.AF_UNIX)
        if line.connect_ex(address := str(folder / "calls")):
            (folder / "calls").unlink(missing_ok=True)
            with socket.socket(socket.AF_UNIX) as listening:
                listening.bind(address)
                listening.listen(64)
                words = [sys.executable, __file__, str(fd := listening.fileno())]
                server = subprocess.Popen(words, pass_fds=[fd], stdin=subprocess.DEVNULL, cwd=folder)
            atexit.register(server.wait)
            line.connect(address)
    line.sendall(bytes(4))
    atexit.register(line.close)
    return folder


def _write_programs(folder: Path) -> None:
    folder.mkdir()
    for name, words in PROGRAMS.items():
        address = str(folder.with_name("warm") / "calls")
        text = CALLER.format(
            python=sys.executable,
            address=address,
            words=words,
            added=len(words),
            freeze=int(FREEZE),
            thaw=int(THAW),
        )
        (folder / name).write_text(text)
        (folder / name).chmod(0o755)


def import_everything() -> None:
    """Import the core, the driver, the plug-ins and their languages, so that no call has to."""
    import cv2  # noqa: F401
    import zenoh  # noqa: F401
    from pymavlink import mavutil

    from mmrs_core.resources import shipped

    mavutil.set_dialect("ardupilotmega")
    plugins = entry_points(group="mmrs.plugins")
    for name in sorted({"mmrs_core", "mmrs_runtime", "auv_vessel", "auv_vision", *map(_package, plugins)}):
        _import_all(name)
    _carry_out(shipped("examples") / "drone-and-rover")


def _carry_out(example: Path) -> None:
    """Take an example through the usual commands, which keep what they make only once."""
    from mmrs_core.cli import run

    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        project = str(shutil.copytree(example, Path(folder, "project")))
        code = ("generate", project, "--target", "mavlink-python", "-o", f"{folder}/code")
        for command in (("plan", project), code, ("preview", project)):
            assert run(list(command), program="mmrs") == 0


def _import_all(name: str) -> None:
    """Import a package with all in it but the kit for tests: pytest wants to import hypothesis by itself."""
    for module in pkgutil.iter_modules(__import__(name, fromlist=[""]).__path__, f"{name}."):
        if not module.name.endswith((".testing", "__main__", ".stubs.write")):
            __import__(module.name)
            if module.ispkg:
                _import_all(module.name)


def _package(plugin: EntryPoint) -> str:
    return plugin.module.partition(".")[0]


class Server:
    """Takes calls, forks for each, and tells callers how theirs has ended, until no user is left."""

    def __init__(self, listening: socket.socket) -> None:
        self._listening = listening
        self._lines: dict[int, socket.socket] = {}
        self._users: set[socket.socket] = set()
        self._wake = os.pipe()
        for end in self._wake:
            os.set_blocking(end, False)
        self._watched = selectors.DefaultSelector()
        for each in (listening, self._wake[0]):
            self._watched.register(each, selectors.EVENT_READ)
        signal.signal(signal.SIGCHLD, lambda number, frame: None)
        signal.set_wakeup_fd(self._wake[1])

    def serve(self) -> tuple[list[str], list[int]]:
        """Take calls; return in the fork of one, with what is said and its standard files."""
        while True:
            for key, _ in self._watched.select():
                if key.fileobj is self._listening:
                    line, _ = self._listening.accept()
                    if call := self._call(line):
                        return call
                elif key.fileobj == self._wake[0]:
                    os.read(self._wake[0], 1 << 12)
                    self._bury()
                elif key.fileobj in self._users:
                    self._leave(key.fileobj)  # type: ignore[arg-type]
                else:
                    self._kill(key.data)

    def _call(self, line: socket.socket) -> tuple[list[str], list[int]] | None:
        size, fds, _, _ = socket.recv_fds(line, 4, 3)
        if not any(size):
            self._users.add(line)
            self._watched.register(line, selectors.EVENT_READ)
            return None
        text = b""
        while len(text) < int.from_bytes(size, "big") and (more := line.recv(1 << 16)):
            text += more
        pid = os.fork()
        if pid == 0:
            self._let_go(line)
            return text.decode("utf-8", "surrogateescape").split("\0"), fds
        for fd in fds:
            os.close(fd)
        self._lines[pid] = line
        with contextlib.suppress(BrokenPipeError):  # a caller that was killed already ends its fork below
            line.sendall(pid.to_bytes(4, "big"))
        self._watched.register(line, selectors.EVENT_READ, pid)
        return None

    def _let_go(self, line: socket.socket) -> None:
        """Close in a fork what only the server needs."""
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        self._watched.close()
        for each in (line, self._listening, *self._lines.values(), *self._users):
            each.close()
        for end in self._wake:
            os.close(end)

    def _bury(self) -> None:
        with contextlib.suppress(ChildProcessError):
            while (found := os.waitpid(-1, os.WNOHANG))[0]:
                line = self._lines.pop(found[0])
                with contextlib.suppress(KeyError):
                    self._watched.unregister(line)
                with contextlib.suppress(OSError):
                    line.sendall(found[1].to_bytes(4, "big"))
                line.close()

    def _kill(self, pid: int) -> None:
        """End the fork of a caller that is no more."""
        self._watched.unregister(self._lines[pid])
        os.kill(pid, signal.SIGKILL)

    def _leave(self, user: socket.socket) -> None:
        self._watched.unregister(user)
        self._users.remove(user)
        if not self._users:
            for pid in self._lines:
                os.kill(pid, signal.SIGKILL)
            for pid in self._lines:
                os.waitpid(pid, 0)
            sys.exit()


def become(said: list[str], fds: list[int]) -> None:
    """Go on as the Python that was called."""
    for number, fd in enumerate(fds):
        os.dup2(fd, number)
        os.close(fd)
    _, folder, count, *rest = said
    arguments, variables = rest[: int(count)], rest[int(count) :]
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(each.split("=", 1) for each in variables)
    sys.path[:0] = filter(None, os.environ.get("PYTHONPATH", "").split(os.pathsep))
    sys.stdin = open(0, closefd=False)  # noqa: SIM115
    sys.stdout = open(1, "w", closefd=False)  # noqa: SIM115
    sys.stderr = open(2, "w", errors="backslashreplace", buffering=1, closefd=False)  # noqa: SIM115
    try:
        run(arguments)
    except SystemExit as ending:
        if ending.code is not None and not isinstance(ending.code, int):
            raise
        leave(ending.code or 0)
    else:
        leave(0)


def leave(code: int) -> None:
    """End as Python does, but for taking all apart that was imported, which takes longer than most programs.

    Returns where what was said cannot be written: let Python say so.
    """
    threading._shutdown()  # type: ignore[attr-defined]
    atexit._run_exitfuncs()
    try:
        for each in (sys.stdout, sys.stderr):
            if each is not None and not each.closed:
                each.flush()
    except OSError:
        return
    os._exit(code & 0xFF)


def run(arguments: list[str]) -> None:
    """Run what a command line of Python names."""
    import warnings

    while True:
        match arguments:
            case ["-u" | "-B", *arguments]:
                sys.stdout.reconfigure(write_through=True)  # type: ignore[union-attr]
            case ["-W", action, *arguments]:
                warnings.simplefilter(action)  # type: ignore[arg-type]
            case ["-c", code, *words]:
                sys.argv = ["-c", *words]
                sys.path.insert(0, "")
                exec(compile(code, "<string>", "exec"), {"__name__": "__main__"})  # noqa: S102
                return
            case ["-m", module, *words]:
                if module == "pytest":
                    sys.path.append(str(Path(__file__).parent))
                    words = ["-p", "same_examples", *words]
                sys.argv = ["-m", *words]
                sys.path.insert(0, str(Path.cwd()))
                runpy.run_module(module, run_name="__main__", alter_sys=True)
                return
            case [script, *words]:
                sys.argv = [script, *words]
                sys.path.insert(0, str(Path(script).resolve().parent))
                runpy.run_path(script, run_name="__main__")
                return


if __name__ == "__main__":
    if (shared.folder() / "plans").is_dir():
        from plans_once import remember_plans, remember_plugins

        remember_plans()
        remember_plugins()
    sys.path.remove(str(Path(__file__).parent))
    import_everything()
    gc.collect()
    gc.set_threshold(*shared.SELDOM)
    become(*Server(socket.socket(fileno=int(sys.argv[1]))).serve())
