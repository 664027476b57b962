"""What is wrong with the command line of a run, as far as it concerns vehicles on MAVLink."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from pathlib import Path

from mmrs_core.errors import UsageError
from mmrs_mavlink.links.ports import address_of, split_system
from mmrs_mavlink.links.signing import signer_for
from mmrs_mavlink.plugin.backend.options import link_options
from mmrs_runtime.injection import injections

_SERIAL = re.compile(r"/|COM\d+", re.IGNORECASE)
"""How names of serial devices begin."""


def faults_of(options: Mapping[str, Mapping[str, str]], links: Mapping[str, str]) -> Iterator[str]:
    """Yield invalid options, keys, links and injected faults.

    Args:
        options: by robot of this backend.
        links: of all robots of this process, by robot; empty where none is given.

    Raises:
        OSError: a key cannot be read.
    """
    for given in options.values():
        try:
            link_options(given)
        except UsageError as error:
            yield f"--backend-option {str(error).removeprefix('option ')}"
    yield from _of_key(options)
    yield from _of_links({robot: links[robot] for robot in options if links.get(robot)})
    for inject in dict.fromkeys(given["inject"] for given in options.values() if given.get("inject")):
        try:
            injections([inject], links)
        except ValueError as error:
            yield f"--inject {error}"


def _of_key(options: Mapping[str, Mapping[str, str]]) -> Iterator[str]:
    for path in dict.fromkeys(given["signing-key"] for given in options.values() if "signing-key" in given):
        try:
            signer_for(Path(path))
        except ValueError as error:
            yield f"--signing-key {error}"


def _of_links(links: Mapping[str, str]) -> Iterator[str]:
    reached: dict[tuple[str, int], str] = {}
    for robot, text in links.items():
        try:
            url, system = split_system(text)
            if address_of(url) is None and not _SERIAL.match(url):
                raise ValueError(f"{url}: is neither udpin:, udpout: or tcp:HOST:PORT nor a serial device")
        except ValueError as error:
            yield f"--connect {error}"
            continue
        if system and (other := reached.setdefault((url, system), robot)) != robot:
            yield f"--connect {text}: is given to '{other}' and to '{robot}'"
