"""The radios of a process: robots that share a url share its port."""

from __future__ import annotations

import threading
from collections.abc import Callable

from mmrs_runtime.clock import Clock
from mmrs_runtime.faults import LINK_LOST, FaultError, RefusedError
from mmrs_runtime.ports import Port

from .link import Link
from .ports import open_port
from .radio import Radio
from .retries import Retries
from .signing import Signer


class Radios:
    """Opens links, and each port once."""

    def __init__(
        self,
        clock: Clock,
        signer: Signer | None = None,
        retries: Retries | None = None,
        wrap: Callable[[Port, str], Port] = lambda port, url: port,
    ) -> None:
        """Open nothing yet.

        Args:
            clock: of the run.
            signer: None: nothing is signed.
            retries: None: as published.
            wrap: puts something in front of the port of a url.
        """
        self._clock = clock
        self._signer = signer
        self._retries = retries
        self._wrap = wrap
        self._radios: dict[str, Radio] = {}
        self._lock = threading.Lock()

    def open(self, url: str, system: int = 0) -> Link:
        """Return a link to a vehicle, which need not have spoken yet.

        Args:
            url: of the port.
            system: of the vehicle; 0 is whichever speaks first that no other robot has.

        Raises:
            FaultError: the port cannot be opened, or another robot has that vehicle.
        """
        with self._lock:
            radio = self._radios.get(url)
            if radio is None or not radio.listening:
                radio = self._radios[url] = Radio(self._port(url), self._clock, self._signer)
            try:
                return Link(radio, self._clock, system, retries=self._retries)
            except ValueError as error:
                raise RefusedError(f"{url}: {error}") from error

    def meet(self, link: Link, url: str, seconds: float) -> None:
        """Wait for a vehicle's first message.

        Raises:
            FaultError: none comes; names what was received instead.
        """
        if link.wait(lambda: link.component, seconds):
            return
        reasons = [link.strangers(), link.trouble]
        if link.garbled:
            reasons.insert(
                0, f"{link.garbled} frames from there could not be read, or are not signed with the key"
            )
        why = "".join(f"; {reason}" for reason in reasons if reason)
        raise FaultError(LINK_LOST, f"no vehicle at {url}{why}")

    def _port(self, url: str) -> Port:
        try:
            return self._wrap(open_port(url), url)
        except OSError as error:
            raise FaultError(LINK_LOST, f"{url}: {error.strerror or error}") from error
