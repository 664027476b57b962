"""What generated Python programs need on the computer that runs them: wheels, pinned versions, a service."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib.metadata import Distribution, PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

from mmrs_core.contributions.targets import FileSpec
from mmrs_core.errors import MmrsError
from mmrs_core.generation.wheels import wheel_of

WHEELS, REQUIREMENTS = "wheels", "requirements.txt"


@dataclass(frozen=True, slots=True)
class Deployment:
    """What programs need of Python distributions.

    Attributes:
        carried: distributions whose wheels lie beside the programs, each with extras or without, such as
            ``mmrs-runtime[bus]``.
        pins: name and version of each distribution that these need beside one another.
    """

    carried: tuple[str, ...]
    pins: tuple[tuple[str, str], ...]

    @property
    def libraries(self) -> tuple[str, ...]:
        """Return the names of the distributions that come from elsewhere."""
        return tuple(name for name, _ in self.pins)

    def files(self, mission: str, modules: Sequence[str]) -> Iterator[FileSpec]:
        """Yield wheels, requirements and the service that runs one of these modules.

        Raises:
            MmrsError: a distribution is not installed, or no wheel can be made of it.
        """
        names: list[str] = []
        for text in self.carried:
            required = Requirement(text)
            wheel = wheel_of(required.name)
            extras = ",".join(sorted(required.extras))
            names.append(f"{WHEELS}/{wheel.name}" + (f"[{extras}]" if extras else ""))
            yield FileSpec(f"{WHEELS}/{wheel.name}", "", data=wheel.content)
        needs = {"carried": names, "pins": [f"{name}=={version}" for name, version in self.pins]}
        yield FileSpec(REQUIREMENTS, "requirements.txt.jinja", {"mission": mission, **needs})
        service = {"mission": mission, "modules": modules}
        yield FileSpec("mmrs@.service", "mmrs@.service.jinja", service)


@cache
def deployment_of(*carried: str) -> Deployment:
    """Return what programs need that run on these distributions, by what is installed here.

    Args:
        carried: as in `Deployment`; an extra is left out where not all that it needs is installed.

    Raises:
        MmrsError: something that they need is not installed.
    """
    asked = [Requirement(text) for text in carried]
    kept = [_text(each, {extra for extra in each.extras if _has(each.name, extra)}) for each in asked]
    ours = {canonicalize_name(each.name) for each in asked}
    found: dict[str, str] = {}
    seen, pending = set(), [Requirement(text) for text in kept]
    while pending:
        needed = pending.pop()
        name = canonicalize_name(needed.name)
        if (key := (name, frozenset(needed.extras))) in seen:
            continue
        seen.add(key)
        installed = _installed(needed.name)
        if name not in ours:
            found[name] = installed.version
        pending += _needs(installed, needed.extras or {""})
    return Deployment(tuple(kept), tuple(sorted(found.items())))


def fetch(folder: Path, platforms: Sequence[str]) -> None:
    """Download the wheels of pinned requirements into a generated folder.

    Args:
        folder: with the requirements.
        platforms: tags of wheels that the computer can run, such as ``manylinux2014_aarch64``.

    Raises:
        MmrsError: the folder has no requirements, or pip fails.
    """
    if not (folder / REQUIREMENTS).is_file():
        raise MmrsError(f"{folder}: has no {REQUIREMENTS}, which lists the wheels that are needed")
    lines = (folder / REQUIREMENTS).read_text("utf-8").splitlines()
    pins = [line for line in lines if "==" in line and not line.startswith("#")]
    if not pins:
        return
    command = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet", "download", "--no-deps"]
    command += ["--only-binary=:all:", "--dest", str(folder / WHEELS)]
    command += [word for platform in platforms for word in ("--platform", platform)]
    done = subprocess.run([*command, *pins], capture_output=True, text=True, check=False)
    if done.returncode:
        said = done.stderr.strip().splitlines() or [f"pip has ended with {done.returncode}"]
        raise MmrsError(f"--wheels {' '.join(platforms)}: {said[-1].removeprefix('ERROR: ')}")


def _text(required: Requirement, extras: set[str]) -> str:
    return required.name + (f"[{','.join(sorted(extras))}]" if extras else "")


def _has(name: str, extra: str) -> bool:
    """Return whether all is installed that a distribution needs for an extra."""
    try:
        for each in _needs(_installed(name), {extra}):
            distribution(each.name)
    except PackageNotFoundError:
        return False
    return True


def _needs(installed: Distribution, extras: set[str]) -> list[Requirement]:
    requirements = map(Requirement, installed.requires or ())
    return [
        each
        for each in requirements
        if each.marker is None or any(each.marker.evaluate({"extra": extra}) for extra in extras)
    ]


def _installed(name: str) -> Distribution:
    try:
        return distribution(name)
    except PackageNotFoundError as error:
        raise MmrsError(
            f"distribution {name}: is not installed, and programs that are generated need it"
        ) from error
