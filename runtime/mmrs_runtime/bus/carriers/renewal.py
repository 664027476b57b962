"""Reading keys again while they are in use, to shut out certificates that are revoked meanwhile."""

from __future__ import annotations

import threading
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..threads import Net
from .revocation import REVOKED
from .sessions import Endpoints, admitted, configuration, revoked_by

LOOK_SECONDS = 2.0
"""How often the files are looked at."""

STOP_SECONDS = 2.0
"""How long the end may take."""


class Renewal:
    """Looks, in a thread of its own, whether others are to be let in than before."""

    def __init__(self, endpoints: Endpoints, file: Path, renew: Callable[[Any], None], net: Net) -> None:
        """Take the files as they are now.

        Args:
            endpoints: with the file. file: the configuration.
            renew: opens a session with a configuration instead of the session there is; where it raises
                OSError, it is called again.
            net: tells people, each thing once.

        Raises:
            OSError: as `configuration` does.
        """
        self._endpoints, self._renew, self._net = endpoints, renew, net
        self._files = (file, file.with_name(REVOKED))
        self._seen = self._contents()
        self._revoked = revoked_by(file)
        self._access: str | None = _access(configuration(endpoints))
        self._over = threading.Event()
        self._thread = threading.Thread(target=self._watch, name="bus keys", daemon=True)

    def start(self) -> None:
        """Begin to look."""
        self._thread.start()

    def stop(self) -> None:
        """End; a session that is being opened is waited for, but not for long."""
        self._over.set()
        if self._thread.is_alive():
            self._thread.join(STOP_SECONDS)

    def _watch(self) -> None:
        while not self._over.wait(LOOK_SECONDS):
            with self._net.under("reading keys again"):
                self.look()

    def look(self) -> None:
        """Check once; a problem with changed files is reported, and nothing changes.

        Raises:
            OSError: the session cannot be reopened.
        """
        contents = self._contents()
        if contents == self._seen and self._access is not None:
            return
        self._seen = contents
        try:
            config = configuration(self._endpoints, self._revoked)
            self._revoked += revoked_by(self._files[0])
        except OSError as error:
            self._net.tell(f"{error}; the previous keys stay in use")
            return
        if (access := _access(config)) != self._access:
            self._net.tell(
                f"keys have changed; reopened, accepting the certificates {', '.join(admitted(config))}"
            )
            self._access = None  # until the session is open
            self._renew(config)
            self._access = access

    def _contents(self) -> list[bytes]:
        found = []
        for file in self._files:
            with suppress(OSError):
                found.append(file.read_bytes())
        return found


def _access(config: Any) -> str:
    return str(config.get_json("access_control"))
