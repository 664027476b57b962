"""Eclipse EMF as a referee: a small Java program of ours around the libraries."""

import os
import subprocess
import threading
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest
from lxml import etree

from mmrs_core.languages.registry import MetamodelSource, registry_with

HERE = Path(__file__).parent
PROJECT = HERE.parents[2]
JARS = [Path("/usr/share/java") / f"eclipse-emf-{name}.jar" for name in ("common", "ecore", "ecore-xmi")]
OPTIONS = ("-Xshare:auto", "-XX:TieredStopAtLevel=1", "-Xmx512m", "-Dfile.encoding=UTF-8")
ELSEWHERE = "Asia/Kathmandu"  # whose clocks are 5 h 45 min before UTC, in summer as well
LONGEST_ANSWER = 300  # seconds


@dataclass(frozen=True)
class Verdict:
    """What EMF answered."""

    lines: tuple[str, ...]

    @property
    def faults(self):
        return self.all("FAULT")

    @property
    def accepted(self):
        return not self.faults

    def all(self, word):
        """Return what follows a word at the beginning of lines."""
        return [line.removeprefix(f"{word} ") for line in self.lines if line.startswith(f"{word} ")]


class Referee:
    """One Java process, asked as often as need be."""

    def __init__(self, command, metamodels):
        self._process = subprocess.Popen(
            list(map(str, command)), stdin=subprocess.PIPE, stdout=subprocess.PIPE, encoding="utf-8"
        )
        self._metamodels = metamodels
        self.ask("metamodels", *metamodels)

    def ask(self, *words):
        """Return the answer to a question; what can be asked stands in Referee.java."""
        watch = threading.Timer(LONGEST_ANSWER, self._process.kill)
        watch.start()
        try:
            self._process.stdin.write("\t".join(map(str, words)) + "\n")
            self._process.stdin.flush()
            lines = list(iter(self._line, "DONE"))
        finally:
            watch.cancel()
        return Verdict(tuple(lines))

    @contextmanager
    def knowing(self, *metamodels):
        """Let it know these metamodels and no other for a while; yield what it thinks of them."""
        try:
            yield self.ask("metamodels", *metamodels)
        finally:
            self.ask("metamodels", *self._metamodels)

    def close(self):
        self._process.stdin.close()
        self._process.stdout.close()
        self._process.wait(timeout=30)

    def _line(self):
        line = self._process.stdout.readline()
        assert line, "the referee has ended"
        return line.rstrip("\n")


@pytest.fixture(scope="session")
def command(tmp_path_factory, need_program):
    """Return a function that gives the command for a referee whose machine stands in a time zone."""
    java = need_program("java", "Eclipse EMF judges metamodels and models")
    javac = need_program("javac", "the referee is compiled for the tests")
    missing = [jar.name for jar in JARS if not jar.is_file()]
    if missing:
        message = f"{', '.join(missing)}: not installed (Debian: libeclipse-emf-ecore-xmi-java)"
        pytest.fail(message) if os.environ.get("MMRS_REQUIRE_PEERS") == "1" else pytest.skip(message)
    classes = tmp_path_factory.mktemp("referee")
    path = os.pathsep.join(map(str, [classes, *JARS]))
    sources = sorted(HERE.glob("*.java"))
    subprocess.run(
        [javac, "-encoding", "UTF-8", "-cp", path, "-d", classes, *sources], check=True, timeout=120
    )
    return lambda zone: [java, *OPTIONS, f"-Duser.timezone={zone}", "-cp", path, "Referee"]


@pytest.fixture(scope="session")
def referee(command, every_metamodel):
    """Return the referee, who knows all our metamodels and the foreign ones; the zone is UTC."""
    referee = Referee(command("UTC"), every_metamodel)
    yield referee
    referee.close()


@pytest.fixture(scope="session")
def elsewhere(command):
    """Return a referee who lives in another time zone, and knows no metamodel."""
    referee = Referee(command(ELSEWHERE), ())
    yield referee
    referee.close()


@pytest.fixture(scope="session")
def metamodels():
    """Return the .ecore files of the core and the plug-ins, those that others need first."""
    core = [PROJECT / "metamodels" / f"{name}.ecore" for name in ("robot", "mission", "context", "behaviour")]
    return [*core, *plug_ins()]


def plug_ins():
    return sorted((PROJECT / "plugins").glob("*/mmrs_*/metamodels/*.ecore"))


@pytest.fixture(scope="session")
def foreign():
    """Return metamodels that have nothing to do with robots and use what Ecore offers beyond ours."""
    models = PROJECT / "tests" / "fixtures" / "models"
    return [models / f"{name}.ecore" for name in ("zoo", "suite", "parts")]


@pytest.fixture(scope="session")
def every_metamodel(metamodels, foreign):
    return [*metamodels, *foreign]


@pytest.fixture(scope="session")
def registry(foreign):
    """The core, the plug-ins' metamodels and the foreign ones."""
    sources = [
        MetamodelSource(etree.parse(file).getroot().get("nsURI"), file, file.stem) for file in plug_ins()
    ]
    return registry_with(
        [*sources, *(MetamodelSource(f"urn:test:{file.stem}", file, file.stem) for file in foreign)]
    )


COUNTS = pytest.StashKey[list[str]]()


def pytest_configure(config):
    config.stash[COUNTS] = []


def pytest_terminal_summary(terminalreporter, config):
    for line in config.stash[COUNTS]:
        terminalreporter.write_line(line)


@pytest.fixture
def tell(pytestconfig):
    """Return a function that has a line printed once all tests are done."""
    return pytestconfig.stash[COUNTS].append
