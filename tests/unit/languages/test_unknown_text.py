"""The text of elements that are not installed, however their file is laid out."""

import pytest

from mmrs_core.languages.reading import read_text
from mmrs_core.languages.writing import to_xmi

HEAD = (
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:mission="urn:mmrs:mission:1.0" xmlns:q="urn:q"'
)
TASKS = {
    "empty, at the end": '<tasks xsi:type="q:T" name="t"/>',
    "empty, before another": '<tasks xsi:type="q:T" name="t"/><tasks xsi:type="q:T" name="u"/>',
    "with something inside": '<tasks xsi:type="q:T" name="t"><more/></tasks>',
    "with an empty one inside": '<tasks xsi:type="q:T" name="t"><more><less/></more></tasks>',
    "with brackets in a value": """<tasks xsi:type="q:T" name="/>'" note='"/>"'/>""",
    "with a text": '<tasks xsi:type="q:T">a &gt; b</tasks>',
    "with a comment": '<tasks xsi:type="q:T"><!-- </tasks> --></tasks>',
}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16", "iso-8859-1", "windows-1252"])
@pytest.mark.parametrize("tasks", TASKS.values(), ids=TASKS)
def test_what_is_not_installed_is_written_as_it_was_read(tasks, encoding, core):
    declared = f'<?xml version="1.0" encoding="{encoding}"?>'
    text = f'{declared}<mission:Mission {HEAD} name="ä">{tasks}</mission:Mission>'
    model = read_text(text.encode(encoding), "a.xmi", core)
    written = to_xmi(model.roots, core)
    assert "".join(line.strip() for line in written.decode().splitlines()).endswith(
        f"{tasks}</mission:Mission>"
    )
    assert to_xmi(read_text(written, "b.xmi", core).roots, core) == written
