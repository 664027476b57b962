from __future__ import annotations

from pathlib import Path

import mmrs_core.languages as languages
from mmrs_core.languages.metamodels.stubs import write_core_stubs


def test_the_committed_stubs_say_what_the_metamodels_say(core, tmp_path):
    folder = Path(languages.__file__).parent
    made = write_core_stubs(core, tmp_path)
    assert [path.name for path in made] == ["robot.pyi", "mission.pyi", "context.pyi", "behaviour.pyi"]
    for path in made:
        committed = (folder / path.name).read_text()
        assert path.read_text() == committed, "run python -m mmrs_core.languages.metamodels.stubs"


def test_every_class_and_enumeration_is_in_its_stub(core):
    folder = Path(languages.__file__).parent
    for package in core.packages:
        text = (folder / f"{package.name}.pyi").read_text()
        for name in package.members:
            assert f"class {name}(" in text or f"{name}: TypeAlias" in text
