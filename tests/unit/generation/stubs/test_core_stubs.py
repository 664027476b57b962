from pathlib import Path

import mmrs_core.languages as languages
from mmrs_core.generation.stubs.write import write_core_stubs
from mmrs_core.languages.registry import core_registry


def test_the_committed_stubs_say_what_the_metamodels_say(tmp_path):
    folder = Path(languages.__file__).parent
    made = write_core_stubs(core_registry(), tmp_path)
    assert [path.name for path in made] == ["robot.pyi", "mission.pyi", "context.pyi", "behaviour.pyi"]
    for path in made:
        committed = (folder / path.name).read_text()
        assert path.read_text() == committed, "run python -m mmrs_core.generation.stubs.write"


def test_every_class_and_enumeration_is_in_its_stub():
    folder = Path(languages.__file__).parent
    for package in core_registry().packages:
        text = (folder / f"{package.name}.pyi").read_text()
        for name in package.members:
            assert f"class {name}(" in text or f"{name}: TypeAlias" in text
