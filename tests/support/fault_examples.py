"""True examples of faults: models that fail and pass, and the parts in which they differ."""

import re
import runpy
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from difflib import SequenceMatcher
from functools import cache
from pathlib import Path
from tempfile import mkdtemp

from checking import given, rover, square
from diagnostics_page import Example
from mmrs_flyaq.importing import importer_of

from mmrs_core.analysis.constraints import CONSTRAINTS
from mmrs_core.behaviour.log import read_log
from mmrs_core.behaviour.program import Action, RobotProgram
from mmrs_core.contributions.checks import Check, CheckInput, Verdict
from mmrs_core.diagnostics import Diagnostic
from mmrs_core.errors import InvalidModelError, UnreadableError
from mmrs_core.grounding.scenes import ground
from mmrs_core.languages import mission, robot
from mmrs_core.languages.codes import refusal
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import Element, descendants, held, holds, label_of, metaclass_of, root_of
from mmrs_core.languages.evolution.migration import Migration
from mmrs_core.languages.model import Model
from mmrs_core.languages.modelset import read_project
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.registry import MetamodelSource, Registry, core_registry, registry_with
from mmrs_core.languages.writing import to_xmi
from mmrs_core.scene import AreaUse, Corridor, Part
from mmrs_core.testing.conformance import ConstraintConformance
from mmrs_core.testing.models import breaches
from mmrs_core.testing.small_programs import go, hold, use
from mmrs_core.testing.small_programs import robot as robot_with

ROOT = Path(__file__).parents[2]
CASES = ROOT / "tests" / "fixtures" / "constraints"
Finder = Callable[..., Sequence[Diagnostic]]
LONGEST = 6
"""Lines of an example; what is cut off is counted."""
_TAG = re.compile(r"<[\w:.-]+")
_ATTRIBUTE = re.compile(r'\s[\w:.-]+="[^"]*"')
_KEPT = (" name=", " id=", " xsi:type=")


def contrast(failing: bytes, passing: bytes) -> tuple[str, str]:
    """Return what each of two XMI texts has that the other has not, element by element."""
    one, other = (text.decode().splitlines() for text in (failing, passing))
    left: list[str] = []
    right: list[str] = []
    for kind, a, b, c, d in SequenceMatcher(None, one, other, autojunk=False).get_opcodes():
        if kind == "equal":
            continue
        if kind != "replace":  # the lines around tell where something is too many or missing
            a, b, c, d = max(a - 1, 0), b + (b < len(one)), max(c - 1, 0), d + (d < len(other))
        same = kind == "replace" and b - a == d - c
        for i, line in enumerate(one[a:b]):
            left.append(_trimmed(line, other[c + i]) if same else line.strip())
        for i, line in enumerate(other[c:d]):
            right.append(_trimmed(line, one[a + i]) if same else line.strip())
    return _cut(left), _cut(right)


def _trimmed(line: str, other: str) -> str:
    """Return a tag with the attributes in which it differs, and with what it is called."""
    tag = _TAG.search(line)
    if "</" in line or tag is None or (match := _TAG.search(other)) is None or match[0] != tag[0]:
        return line.strip()
    theirs = set(_ATTRIBUTE.findall(other))
    own = _ATTRIBUTE.findall(line)
    told = [each for each in own if each not in theirs or each.startswith(_KEPT)]
    left_out = " …" if len(told) < len(own) else ""
    return f"{tag[0]}{''.join(told)}{left_out}{'/>' if line.rstrip().endswith('/>') else '>'}"


def _cut(lines: Sequence[str]) -> str:
    more = len(lines) - LONGEST
    shown = [line if len(line) <= 160 else f"{line[:158]} …" for line in lines[:LONGEST]]
    return "\n".join((*shown, *([f"… and {more} more lines"] if more > 1 else lines[LONGEST:])))


def _texts(failing: Iterable[Element], passing: Iterable[Element], registry: Registry) -> tuple[str, str]:
    try:
        return contrast(to_xmi(tuple(failing), registry), to_xmi(tuple(passing), registry))
    except ValueError:  # it refers to what stands in no file
        return contrast(_sketched(failing), _sketched(passing))


def _sketched(roots: Iterable[Element]) -> bytes:
    """Return a line for each element, with what it refers to by its name."""
    here, lines = tuple(roots), []
    for root in here:
        for element in (root, *descendants(root)):
            features = metaclass_of(element).features
            told = [f for f in features if f.stored and not f.containment and holds(element, f)]
            values = "".join(
                f' {f.name}="{" ".join(_word(v, here) for v in held(element, f))}"' for f in told
            )
            lines.append(f"<{type(element).__name__}{values}/>")
    return "\n".join(lines).encode()


def _word(value: object, here: Sequence[Element]) -> str:
    if not isinstance(value, Element):
        return str(value)
    called = label_of(value) or type(value).__name__
    return called if root_of(value) in here else f"{called} of another model"


def core_examples(fresh_models: Callable[[], object]) -> dict[str, Example]:
    """Return an example of each constraint of the core."""
    found = {}
    by_code = {constraint.code: constraint for constraint in CONSTRAINTS}
    for file in sorted(CASES.glob("*_cases.py")):
        for code, (breach, near, *_) in runpy.run_path(str(file))["CASES"].items():
            failing, passing = fresh_models(), fresh_models()
            breach(failing)
            near(passing)
            message = failing.faults([by_code[code]])[0].message
            roots = [(m.mission, m.context, m.quad, m.behaviour) for m in (failing, passing)]
            found[code] = Example(message, *_texts(*roots, failing.registry))
    return found


def plugin_examples() -> dict[str, Example]:
    """Return an example of each constraint of the plug-ins in this checkout."""
    found = {}
    for file in sorted((ROOT / "plugins").glob("*/tests/test_con*.py")):
        for kit in runpy.run_path(str(file)).values():
            if isinstance(kit, type) and issubclass(kit, ConstraintConformance) and hasattr(kit, "cases"):
                own = getattr(kit.plugin, "mmrs_metamodels", tuple)()
                registry = registry_with((*own, *kit.more_metamodels))
                for constraint in kit.plugin.mmrs_constraints():
                    case = kit.cases[constraint.code]
                    failing, passing = tuple(case.broken(registry)), tuple(case.kept(registry))
                    (message,) = breaches(constraint, failing)
                    found[constraint.code] = Example(message, *_texts(failing, passing, registry))
    return found


_HEAD = (
    '<mission:Mission xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:mission="urn:mmrs:mission:1.0">\n'
)
_PROGRAM = re.compile(r"root = |^m\.|^read|^write")
_WHOLE = re.compile(r"<\w+:|<[A-Z]")
ZOO = ROOT / "tests" / "fixtures" / "models" / "zoo.ecore"
READING = ROOT / "tests" / "fixtures" / "diagnostics" / "reading_cases.py"


def reading_cases(
    folder: Path, fresh_models: Callable[[], object]
) -> dict[str, tuple[Finder, object, object]]:
    """Return, by code, what finds the faults of a case, and the two cases."""
    found = {}
    tables = runpy.run_path(str(READING))
    finders = {
        "TEXTS": _of_text,
        "FILES": lambda files: _of_files(files, folder),
        "PROGRAMS": _of_program,
        "GROUNDED": lambda edit: _of_ground(edit, fresh_models()),
        "VERSIONS": _of_version,
        "DIALECTS": lambda text: _of_dialect(text, folder),
        "LINES": lambda line: _of_log(line, folder),
        "RAW": _of_raw,
        "OPENED": lambda program: _of_program_on_files(program, folder),
    }
    for table, finder in finders.items():
        found |= {code: (finder, *case) for code, case in tables[table].items()}
    return found


def reading_examples(folder: Path, fresh_models: Callable[[], object]) -> dict[str, Example]:
    """Return an example of each fault of reading, metamodels and projects."""
    found = {}
    for code, (finder, failing, passing) in reading_cases(folder, fresh_models).items():
        message = next(fault.message for fault in finder(failing) if fault.code == code)
        language = "python" if _PROGRAM.search(str(failing)) else "xml"
        found[code] = Example(
            message.replace(str(folder), "."), _written(failing), _written(passing), language
        )
    return found


def _written(case: object) -> str:
    if isinstance(case, dict):
        return "\n".join(f"<!-- {name} -->\n{text}" for name, text in case.items())
    return str(case)


def _wrapped(text: str) -> str:
    return (
        text if _WHOLE.match(text) and not text.startswith("<xmi:") else f"{_HEAD}{text}\n</mission:Mission>"
    )


@cache
def _zoo() -> Registry:
    return _zoo_of("zoo")


def _zoo_of(provider: str) -> Registry:
    return registry_with([MetamodelSource("urn:test:zoo", ZOO, provider)])


def _of_text(text: str) -> list[Diagnostic]:
    model = read_text(_wrapped(text).encode(), "mission.xmi", _zoo())
    return [*model.diagnostics, *check_conformance(model, _zoo())]


def _of_files(files: dict[str, str], folder: Path) -> tuple[Diagnostic, ...]:
    place = Path(mkdtemp(dir=folder))
    (place / "robots").mkdir()
    for name, text in files.items():
        (place / name).write_text(_wrapped(text), encoding="utf-8")
    found = read_project(place, registry=core_registry())[1]
    return tuple(replace(each, message=each.message.replace(f"{place}/", "")) for each in found)


def _of_program(program: str) -> tuple[Diagnostic, ...]:
    home = mission.GeoCoordinate(latitude=42.0, longitude=13.0)
    names = {
        "mission": mission,
        "robot": robot,
        "zoo": _zoo(),
        "elsewhere": _zoo_of("elsewhere"),
        "home": home,
    }
    exec(program, names)  # noqa: S102  our own fixtures
    root = names["root"]
    return check_conformance(Model("model", (root,)), _zoo())


def _of_version(text: str) -> tuple[Diagnostic, ...]:
    tables = runpy.run_path(str(READING))
    step = Migration(
        tables["OLD_ZOO"], "urn:test:zoo", features=tables["RENAMED"], dropped=frozenset(tables["DROPPED"])
    )
    registry = registry_with([MetamodelSource("urn:test:zoo", ZOO, "zoo")], [step])
    return read_text(text.encode(), "zoo.xmi", registry).diagnostics


def _of_dialect(text: str, folder: Path) -> tuple[Diagnostic, ...]:
    place, port = Path(mkdtemp(dir=folder)), runpy.run_path(str(READING))["PORT"]
    (place / "port.toml").write_text(port, encoding="utf-8")
    gulls = port.replace("urn:mmrs:robot:1.0", "urn:gulls:1.0").replace(
        "urn:example:port", "urn:example:gulls"
    )
    (place / "gulls.toml").write_text(gulls, encoding="utf-8")
    importers = [importer_of("Port", place / "port.toml"), importer_of("Gulls", place / "gulls.toml")]
    try:
        file = "tug.json" if text.startswith("{") else "tug.xmi"
        return read_text(text.encode(), file, registry_with([], importers=importers)).diagnostics
    except UnreadableError as error:
        return tuple(replace(each, message=each.message.replace(f"{place}/", "")) for each in refusal(error))


def _of_ground(edit: str, models: object) -> tuple[Diagnostic, ...]:
    (kite,) = read_text(b'<kites:Kite xmlns:kites="urn:kites:1.0" name="Red"/>', "kite.xmi", _zoo()).roots
    exec(edit, {"m": models, "mission": mission, "kite": kite})  # noqa: S102  our own fixtures
    try:
        ground(models.as_set)
    except InvalidModelError as error:
        return error.diagnostics
    return ()


def _of_log(line: str, folder: Path) -> tuple[Diagnostic, ...]:
    file = Path(mkdtemp(dir=folder)) / "run.jsonl"
    file.write_text(f"{line}\n", encoding="utf-8")
    try:
        read_log(file)
    except InvalidModelError as error:
        return error.diagnostics
    return ()


def _of_raw(text: str) -> tuple[Diagnostic, ...]:
    try:
        return read_text(
            text.encode(), "m.json" if text.startswith("{") else "m.xmi", core_registry()
        ).diagnostics
    except UnreadableError as error:
        return refusal(error)


def _of_program_on_files(program: str, folder: Path) -> tuple[Diagnostic, ...]:
    """Return what the last line of a program finds in its folder, in which a mission stands already."""
    place = Path(mkdtemp(dir=folder))

    def write(name: str, text: str = "", megabytes: int = 0) -> None:
        with (place / name).open("w", encoding="utf-8") as file:
            file.write(text)
            file.truncate(megabytes * 1024 * 1024 or len(text))

    def read(name: str) -> Sequence[Diagnostic]:
        return read_model(place / name, core_registry()).diagnostics

    def project(name: str) -> Sequence[Diagnostic]:
        return read_project(place / name, registry=core_registry())[1]

    (place / "robots").mkdir()
    write("mission.xmi", f"{_HEAD}</mission:Mission>")
    names = {
        "read": read,
        "write": write,
        "read_project": project,
        "MISSION": _HEAD,
        "END": "</mission:Mission>",
    }
    *lines, last = program.splitlines()
    try:
        exec("\n".join(lines), names)  # noqa: S102  our own fixtures
        found = tuple(eval(last, names))  # noqa: S307  our own fixtures
    except UnreadableError as error:
        found = refusal(error)
    return tuple(replace(each, message=each.message.replace(f"{place}/", "")) for each in found)


_VERDICTS = ROOT / "tests" / "golden" / "analysis" / "expected"


def verdict_examples() -> dict[str, Example]:
    """Return, by property, what is said of a behaviour that is not safe and of one that is."""
    broken, sound = (_told(_VERDICTS / name) for name in ("broken.txt", "sound.txt"))
    found = {}
    for name in broken:
        bad = [each for each in broken[name] if not _SAFE.match(each)]
        good = [each for each in (*sound.get(name, ()), *broken[name]) if _SAFE.match(each)]
        if bad and good:
            found[name] = Example("", bad[0], good[0], "text")
    return found


def judged_cases() -> dict[str, tuple[str, str]]:
    """Return the robots, with their environment, that a check is to find wrong and right, by its name."""
    return runpy.run_path(str(READING))["JUDGED"]


def judged(checks: Iterable[Check], name: str, case: str) -> tuple[Verdict, ...]:
    """Return what a check says of a case."""
    names = {
        "robot": robot_with,
        "hold": hold,
        "go": go,
        "image": _image,
        "replace": replace,
        "asked": _asked,
        "photographed": _photographed,
        "area": _lawn,
    }
    asked = eval(f"asked({case})", names)  # noqa: S307  our own fixtures
    return tuple(next(check for check in checks if check.name == name).run(asked))


def judged_examples(checks: Sequence[Check]) -> dict[str, Example]:
    """Return, by property, what is said of cases that no golden behaviour breaks."""
    found = {}
    for name, cases in judged_cases().items():
        bad, good = ("\n".join(map(_line, judged(checks, name, case)[:1])) for case in cases)
        found[name] = Example("", bad, good, "text")
    return found


def _line(verdict: Verdict) -> str:
    margin = "" if verdict.margin is None else f" {verdict.margin:.3f} {verdict.unit}"
    return f"{verdict.property}: {verdict.status.value}{margin}\n    {verdict.message}"


def _asked(
    made: RobotProgram,
    environment: Mapping[str, float] | None = None,
    meadow: float | None = None,
    gate: float | None = None,
    **tasks: Part,
) -> CheckInput:
    """Return what to check.

    With a meadow so many metres east of home, a policy leads the robot to it; a gate is a corridor from 20 m
    to 60 m east of home, so many metres wide.
    """
    bounds = Part((), {"min": -10.0, "max": 40.0})
    type = rover(max_payload=1.0, attributes={"operatingTemperature": bounds})
    asked = given(made, type=type, environment=environment or {}, tasks=tasks)
    if gate is not None:
        return replace(asked, areas=(), corridors=(Corridor("gate", ((20.0, 0.0), (60.0, 0.0)), gate),))
    if meadow is None:
        return asked
    area = square("meadow", (meadow, 0.0), 20.0, use=AreaUse.EMERGENCY)
    return replace(asked, areas=(area,), rally_points={made.id: ((meadow, 0.0),)})


def _image(needed: float) -> Action:
    return replace(use("camera", "shoot"), parameters=(("minimumIrradiance", f"{needed:g}"),))


def _photographed(*places: tuple[float, float]) -> RobotProgram:
    photo = (use("camera", "TakePicture"),)
    moves = [go(f"at {east:g}", (east, north, 20.0), task="lawn", after=photo) for east, north in places]
    return robot_with("a", moves, home=(0.0, 10.0, 20.0))


def _lawn(width: float) -> Part:
    shell = ((0.0, 0.0, 0.0), (width, 0.0, 0.0), (width, 20.0, 0.0), (0.0, 20.0, 0.0))
    given = {"shell": shell, "altitude": 20.0, "gridResolution": 20.0, "actionName": "TakePicture"}
    return Part((("urn:mmrs:survey:1.0", "PhotoGridTask"),), given)


_SAFE = re.compile(r"\w+: safe")


def _told(file: Path) -> dict[str, list[str]]:
    """Return verdicts by property, each with the line that explains it."""
    found: dict[str, list[str]] = {}
    lines = file.read_text(encoding="utf-8").splitlines()
    for line, following in zip(lines, (*lines[1:], ""), strict=True):
        if not line.startswith(" "):
            found.setdefault(line.partition(":")[0], []).append(f"{line}\n{following}")
    return found
