"""A program that speaks to a gateway of the bus as one without Zenoh does: lines of JSON over a socket."""

import json
import socket
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Self


class Client:
    """A socket, as a program in C would have it."""

    def __init__(self, port: int) -> None:
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=10.0)
        self._lines = self.socket.makefile("rb")

    def say(self, line: object) -> None:
        self.socket.sendall(json.dumps(line).encode() + b"\n")

    def hear(self, what: str) -> dict:
        """Return the next line that says that; news of other things is passed over."""
        while line := self._lines.readline():
            found = json.loads(line)
            if found["is"] == what:
                return found
            assert found["is"] in ("changed", "waiting"), found
        raise AssertionError(f"{what} was never said")

    def ask(self, line: object, what: str) -> dict:
        self.say(line)
        return self.hear(what)

    def close(self) -> None:
        self._lines.close()
        self.socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()


@dataclass(frozen=True)
class RunningGateway:
    """The process of a gateway.

    Attributes:
        file: that says where it listens, at which port, and which token it wants to hear.
    """

    process: subprocess.Popen
    file: Path
    port: int
    token: str

    def connect(self) -> Client:
        """Return a client that has said nothing yet."""
        return Client(self.port)

    def hello(self, **more: object) -> dict:
        """Return the first line of a program that knows the token, and says this besides or instead."""
        return {"do": "hello", "token": self.token, **more}
