from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).parents[3]
PLUGINS = {
    "mavlink": "",
    "auv-vessel": "",
    "multicopter": "",
    "auv-vision": "",
    "auv": "[vision]",
    "survey": "",
    "rover": "",
    "solar": "",
    "dronecan": "",
    "flyaq": "",
    "imc": "",
    "moos": "",
}
OURS = {
    "mmrs-core",
    "mmrs-runtime",
    *(name if name.startswith("auv-") else f"mmrs-{name}" for name in PLUGINS),
}


def needed():
    """Return the distributions that a development set-up installs, by name, with their versions."""
    names = {f"mmrs-{name}": extras for name, extras in PLUGINS.items()}
    plugins = (Requirement(f"{name}{extras}") for name, extras in names.items() if name in OURS)
    pending = [Requirement("mmrs-core[dev]"), *plugins]
    found, seen = {}, set()
    while pending:
        requirement = pending.pop()
        key = (canonicalize_name(requirement.name), frozenset(requirement.extras))
        if key in seen:
            continue
        seen.add(key)
        try:
            installed = distribution(requirement.name)
        except PackageNotFoundError:
            continue
        found[key[0]] = installed.version
        for text in installed.requires or []:
            inner = Requirement(text)
            extras = requirement.extras or {""}
            if inner.marker is None or any(inner.marker.evaluate({"extra": extra}) for extra in extras):
                pending.append(inner)
    return {name: version for name, version in found.items() if name not in OURS}


def lines(file):
    text = (ROOT / file).read_text(encoding="utf-8")
    return [line for line in text.splitlines() if line and not line.startswith("#")]


def test_every_version_that_is_installed_is_pinned():
    pins = dict(line.split("==") for line in lines("constraints.txt"))
    assert {name: pins.get(name) for name in needed()} == needed()


def test_the_requirements_name_the_core_and_every_plugin_and_no_address():
    assert {path.parent.name for path in (ROOT / "plugins").glob("*/pyproject.toml")} == PLUGINS.keys()
    plugins = (f"-e plugins/{name}{extras}" for name, extras in PLUGINS.items())
    wanted = ["-c constraints.txt", "-e runtime", "-e .[dev]", *plugins]
    assert sorted(lines("requirements-dev.txt")) == sorted(wanted)
    assert not any(
        "://" in line for file in ("requirements-dev.txt", "constraints.txt") for line in lines(file)
    )
