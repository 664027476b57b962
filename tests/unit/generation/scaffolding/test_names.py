"""What the parts of a new plug-in are called."""

import keyword

import pytest
from counts import many
from hypothesis import example, given, settings
from hypothesis import strategies as st

from mmrs_core.generation.scaffolding.files import GEOMETRIES, PARTS, plain, plugin_files
from mmrs_core.generation.scaffolding.names import plugin_names

NAMES = st.from_regex(r"[a-z][a-z0-9]{1,6}(-[a-z0-9]{1,5}){0,2}", fullmatch=True)
LONGEST = "wwwwwww-wwwww-wwwww"


@pytest.mark.parametrize(
    ("name", "hint"),
    [("Roof Wash", "roof-wash"), ("ROOF_WASH", "roof-wash"), ("3D-scan", "d-scan"), ("!!", "roof-wash")],
)
def test_a_refused_name_comes_with_one_that_will_do(name, hint):
    with pytest.raises(ValueError, match=f"such as '{hint}'"):
        plugin_names(name)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("a" * 31, "31 characters"),
        ("mission", "reserved for the core"),
        ("xmlns", "reserved for the core"),
        ("kites", "is installed"),
        ("kite-line", "is installed"),
        ("x9", "two letters"),
    ],
)
def test_names_that_would_clash_or_number_nothing_are_refused(name, reason):
    with pytest.raises(ValueError, match=reason):
        plugin_names(name, taken=("kites", "kite_line"))


def test_codes_of_constraints_differ_from_those_that_are_there():
    assert plugin_names("surf").code == "SUR001"
    assert plugin_names("surf", codes=("SUR001",)).code == "SURF001"
    assert plugin_names("surf", codes=("SUR001", "SURF004")).code == "SURFX001"
    assert plugin_names("xmit").code == "XMIT001"


@given(NAMES)
def test_every_name_makes_names_that_python_takes(name):
    try:
        names = plugin_names(name)
    except ValueError:
        return
    for each in (names.package, names.language, names.stub, names.task, names.robot, names.rule):
        assert each.isidentifier()
    assert not keyword.iskeyword(names.stub)
    assert not keyword.iskeyword(names.task)


@settings(max_examples=many(200, fast=8))
@given(st.sampled_from(list(GEOMETRIES)), NAMES)
@example("point", LONGEST)
@example("line", LONGEST)
@example("polygon", LONGEST)
def test_every_name_fits_into_every_file(kind, name):
    try:
        names = plugin_names(name)
    except ValueError:
        return
    files = plugin_files(names, PARTS, kind)
    for path, content in files.items():
        if path.endswith(".py"):
            compile(content, path, "exec")
            assert max(map(len, content.decode().splitlines()), default=0) <= 110


@pytest.mark.parametrize("text", ['"', "\\", "<", "&", "\n", "{", "`", "é"])
def test_what_may_mean_something_else_gets_into_no_file(text):
    with pytest.raises(ValueError, match="is not plain"):
        plain(text)
