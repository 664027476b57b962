"""The context layer of MML: the surroundings of a mission.

The classes come from ``context.ecore`` when they are first asked for; the stub beside this file lists them.
"""

from __future__ import annotations

from mmrs_core.languages.registry import core_registry

NS_URI = "urn:mmrs:context:1.0"


def __getattr__(name: str) -> object:
    return globals().setdefault(name, core_registry().package(NS_URI).member(name))


def __dir__() -> list[str]:
    return sorted(("NS_URI", *core_registry().package(NS_URI).members))
