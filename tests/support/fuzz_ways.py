"""All ways by which something from outside is read, for damaged texts to be tried on."""

import re
from collections.abc import Sequence
from pathlib import Path

from fuzzing import Way, sound_texts
from mmrs_flyaq.migrate import migrate
from mmrs_flyaq.plugin import FLYAQ_2015
from mmrs_flyaq.rules.mapping_file import read_mapping

from mmrs_core.analysis.constraints import check_behaviour
from mmrs_core.analysis.fixes.repair import Diagnosis, Repairer
from mmrs_core.contributions.registry import Contributions
from mmrs_core.diagnostics import Diagnostic
from mmrs_core.errors import PluginError, UnreadableError
from mmrs_core.languages import behaviour as bl
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.metamodels.gathering import gathered
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import core_registry
from mmrs_core.languages.writing import to_json, to_xmi
from mmrs_core.pipeline import check_models, read_models

PROJECT = Path(__file__).parents[2]
EXAMPLES = PROJECT / "examples"
LEGACY = PROJECT / "plugins" / "flyaq" / "tests" / "fixtures" / "flyaq"
UNREADABLE, FAULTS, SOUND = "unreadable", "faults", "no fault"


def ways(contributions: Contributions, folder: Path) -> tuple[Way, ...]:
    """Return all ways; the folder is for files that have to stand on the disk."""
    models = sound_texts(EXAMPLES, "*.xmi")
    registry = contributions.languages
    documents = tuple(
        (f"{name}.json", to_json(read_text(text, name, registry).roots, registry))
        for name, text in models
        if b'href="' not in text and b".xmi#" not in text
    )
    metamodels = (*sound_texts(PROJECT / "plugins", "*.ecore"), *sound_texts(PROJECT / "tests", "*.ecore"))
    legacy = (*sound_texts(LEGACY, "*.xmi"), *sound_texts(LEGACY, "*.json"))
    reading = _Reading(contributions)
    return (
        Way("XMI", reading.text, (*models, *map(_widened, models))),
        Way("JSON", reading.text, documents),
        Way("project", reading.project, tuple(each for each in models if "behaviour" not in each[0])),
        Way("ecore", _Metamodels(folder).read, metamodels),
        Way("migrate", _Dialects(folder, contributions).read, legacy),
    )


def large_ways(contributions: Contributions, size: int = 1_000_000) -> tuple[Way, ...]:
    """Return the ways of single models, with texts of about so many bytes."""
    registry, reading = contributions.languages, _Reading(contributions)
    models = [_widened(each, size) for each in sound_texts(EXAMPLES / "mixed-team", "*.xmi")]
    read = ((name, read_text(text, name, registry)) for name, text in models)
    documents = [(f"{name}.json", to_json(model.roots, registry)) for name, model in read]
    return (Way("large XMI", reading.text, tuple(models)), Way("large JSON", reading.text, tuple(documents)))


def _widened(named: tuple[str, bytes], size: int = 40_000) -> tuple[str, bytes]:
    """Return a text whose root holds everything so often that it has about that size."""
    name, text = named
    root = re.search(rb"<\w[^>]*>", text)
    assert root is not None, name
    begin, end = root.end(), text.rindex(b"</")
    return f"wide-{name}", text[:begin] + text[begin:end] * (size // len(text) + 1) + text[end:]


def _ended(faults: Sequence[Diagnostic]) -> str:
    for fault in faults:
        assert fault.code
        assert fault.message
        assert fault.place.file, f"no place: {fault}"
    return FAULTS if faults else SOUND


class _Reading:
    def __init__(self, contributions: Contributions) -> None:
        self._contributions = contributions
        self._registry = contributions.languages

    def text(self, text: bytes, name: str) -> str:
        """Read a text, check it, and write what it holds."""
        try:
            model = read_text(text, name, self._registry)
        except UnreadableError:
            return UNREADABLE
        faults = (*model.diagnostics, *check_conformance(model, self._registry))
        self._behaviour(model)
        if not faults:
            (to_json if name.endswith(".json") else to_xmi)(model.roots, self._registry)
        return _ended(faults)

    def _behaviour(self, model: Model) -> None:
        for root in model.roots:
            if isinstance(root, bl.Behaviour):
                check_behaviour(root, self._contributions.constraints, self._registry)

    def project(self, text: bytes, name: str) -> str:
        """Read and check the whole project that a file belongs to."""
        file = Path(name)
        folder = file.parent.parent if file.parent.name == "robots" else file.parent
        try:
            models, faults = read_models(folder, self._contributions, unsaved={file.resolve(): text})
        except UnreadableError:
            return UNREADABLE
        checked = check_models(models, self._contributions) if models is not None else ()
        if models is not None:
            found = Diagnosis(True, (*faults, *checked), models.models, models, tuple(models.robots.values()))
            repairer = Repairer(self._contributions.fixes, self._registry, (), lambda texts: found)
            sum(1 for _ in repairer.proposals(found, {file.resolve(): text}))
        return _ended((*faults, *checked))


class _Metamodels:
    def __init__(self, folder: Path) -> None:
        self._folder = folder

    def read(self, text: bytes, name: str) -> str:
        """Read a metamodel of the user's and put it beside the core's."""
        file = self._folder / Path(name).name
        file.write_bytes(text)
        core = core_registry()
        try:
            core.extended(gathered([file], core))
        except UnreadableError:
            return UNREADABLE
        except PluginError:
            return FAULTS
        return SOUND


class _Dialects:
    def __init__(self, folder: Path, contributions: Contributions) -> None:
        self._folder = folder / "legacy"
        self._folder.mkdir(exist_ok=True)
        self._registry = contributions.languages
        self._mapping = read_mapping(FLYAQ_2015, self._registry)

    def read(self, text: bytes, name: str) -> str:
        """Migrate a model of the dialect of 2015."""
        file = self._folder / Path(name).name
        file.write_bytes(text)
        try:
            migration = migrate([file], self._mapping, self._registry)
        except UnreadableError:
            return UNREADABLE
        return FAULTS if migration.findings else SOUND
