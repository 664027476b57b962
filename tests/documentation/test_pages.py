"""The code on the pages works: commands are typed, Python is run, files are written as their titles say."""

import shutil
from pathlib import Path

import pytest
from code_blocks import Block, Reader, alike, blocks_of, commands_of, environment
from hypothesis import HealthCheck, settings
from warm_python import programs

pytestmark = pytest.mark.long

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
JUDGED_ELSEWHERE = ("diagnostics.md", "hooks.md", "tutorial/")
"""Pages and folders whose code a test of their own runs, with what that code needs."""

LANGUAGES = {"console", "python", "text", "xml", "toml", "json", "ini"}
NAMES = sorted(path.relative_to(DOCS).as_posix() for path in DOCS.rglob("*.md"))
PAGES = [name for name in NAMES if not name.startswith(JUDGED_ELSEWHERE)]
BLOCKS = {page: blocks_of((DOCS / page).read_text(encoding="utf-8"), page) for page in PAGES}


@pytest.fixture(autouse=True)
def unhurried():
    """Let properties on the pages take their time where the machine is busy."""
    usual = settings.get_current_profile_name()
    settings.register_profile("pages", deadline=None, suppress_health_check=[HealthCheck.too_slow])
    settings.load_profile("pages")
    yield
    settings.load_profile(usual)


@pytest.mark.parametrize("page", [page for page in PAGES if BLOCKS[page]])
def test_what_a_page_says_to_type_does_what_it_says(page, tmp_path):
    shutil.copytree(ROOT / "examples", tmp_path / "examples")
    reader = Reader(tmp_path, environment(programs()))
    for block in BLOCKS[page]:
        reader.follow(block)


def test_every_block_says_what_language_it_is_in():
    blocks = [block for page in PAGES for block in BLOCKS[page]]
    assert blocks
    assert [block.where for block in blocks if block.language not in LANGUAGES] == []


def test_a_reader_notices_a_wrong_exit_code(tmp_path):
    with pytest.raises(AssertionError, match=r"page\.md:1: false: 1"):
        Reader(tmp_path).follow(console("$ false\n"))


def test_a_reader_notices_other_output(tmp_path):
    with pytest.raises(AssertionError, match="echo no prints"):
        Reader(tmp_path).follow(console("$ echo no\nyes\n"))


def test_a_reader_notices_a_wrong_value(tmp_path):
    with pytest.raises(AssertionError, match="Expected:\n    2"):
        Reader(tmp_path).follow(Block("page.md", "python", "", ">>> 1\n2\n", 1))


def test_an_exit_code_in_the_title_is_that_of_the_last_command(tmp_path):
    Reader(tmp_path).follow(console("$ true\n$ exit 4\n", "exit code 4"))


def test_a_title_makes_a_file(tmp_path):
    reader = Reader(tmp_path)
    reader.follow(Block("page.md", "text", "folder/note.txt", "hello\n", 1))
    reader.follow(console("$ cat folder/note.txt\nhello\n"))


def test_names_stay_from_block_to_block(tmp_path):
    reader = Reader(tmp_path)
    reader.follow(Block("page.md", "python", "", "answer = 42\n", 1))
    reader.follow(Block("page.md", "python", "", ">>> answer\n42\n", 3))


def test_blocks_in_tabs_lose_their_indent():
    (block,) = blocks_of("=== one\n\n    ```console\n    $ true\n    ```\n", "page.md")
    assert (block.text, block.line) == ("$ true\n", 3)


def test_a_line_of_dots_stands_for_any_lines_or_none():
    assert alike("first\n...\nlast\n", "first\nsecond\nthird\nlast\n")
    assert alike("first\n...\nlast\n", "first\nlast\n")
    assert not alike("first\n...\nlast\n", "first\nsecond\n")


def test_dots_in_a_line_stand_for_anything_in_it():
    assert alike("done after ...; safe\n", "done after 10:32; safe\n")
    assert not alike("done after ...; safe\n", "done after 10:32\n; safe\n")


def test_output_belongs_to_the_command_before_it():
    assert commands_of(console("$ one\na\nb\n$ two\n")) == [("one", "a\nb\n"), ("two", "")]


def console(text, title=""):
    return Block("page.md", "console", title, text, 1)
