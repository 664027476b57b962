import json
from hashlib import sha256

import pytest
from mmrs_multicopter.testing import target_input, two_drones

from mmrs_core.contributions.targets import FileSpec, Target
from mmrs_core.errors import MmrsError, UnreadableError
from mmrs_core.generation.overrides import overrides_in
from mmrs_core.generation.render import render
from mmrs_mavlink.plugin import mmrs_targets


@pytest.fixture
def target(tmp_path):
    """Return a target with a template, a copied file, and one that is copied from elsewhere."""
    folder = tmp_path / "templates"
    folder.mkdir()
    (folder / "card.txt.jinja").write_text("{% block head %}head\n{% endblock %}{{ who | py }}\n", "utf-8")
    (folder / "copied.txt").write_text("as it is", "utf-8")
    (tmp_path / "engine.py").write_text("x = 1\n", "utf-8")

    def files(given):
        yield FileSpec("card.txt", "card.txt.jinja", {"who": "alpha"})
        yield FileSpec("copied.txt", "copied.txt")
        yield FileSpec("run/engine.py", "engine.py", source=tmp_path / "engine.py")

    return Target("cards", "cards", folder, files, lambda given: [])


@pytest.fixture
def mine(tmp_path):
    (tmp_path / "mine" / "cards" / "run").mkdir(parents=True)
    return tmp_path / "mine"


def made(target, mine, others=()):
    files = render(target, target_input(two_drones()), overrides=overrides_in(mine, target, others))
    return {file.path: file.content.decode() for file in files}


def test_an_empty_folder_changes_nothing(target, mine):
    assert made(target, mine)["card.txt"] == 'head\n"alpha"\n'


def test_a_template_takes_the_place_of_the_targets_own(target, mine):
    (mine / "cards" / "card.txt.jinja").write_text("mine {{ who | py }}\n", "utf-8")
    assert made(target, mine)["card.txt"] == 'mine "alpha"\n'


def test_a_template_extends_the_one_whose_place_it_takes(target, mine):
    text = '{% extends "shipped/card.txt.jinja" %}{% block head %}{{ super() }}mine\n{% endblock %}'
    (mine / "cards" / "card.txt.jinja").write_text(text, "utf-8")
    assert made(target, mine)["card.txt"] == 'head\nmine\n"alpha"\n'


def test_a_block_that_fills_nothing_is_an_error(target, mine):
    text = '{% extends "shipped/card.txt.jinja" %}\n{% block haed %}mine{% endblock %}'
    (mine / "cards" / "card.txt.jinja").write_text(text, "utf-8")
    with pytest.raises(MmrsError, match=r"card.txt.jinja, line 2: .* no block 'haed'; there are head"):
        made(target, mine)


def test_a_block_inside_one_that_is_filled_is_a_templates_own(target, mine):
    inner = "{% block mine %}new\n{% endblock %}"
    text = '{% extends "shipped/card.txt.jinja" %}{% block head %}' + inner + "{% endblock %}"
    (mine / "cards" / "card.txt.jinja").write_text(text, "utf-8")
    assert made(target, mine)["card.txt"] == 'new\n"alpha"\n'


@pytest.mark.parametrize("path", ["copied.txt", "run/engine.py"])
def test_a_copied_file_takes_the_place_of_the_targets_own(target, mine, path):
    (mine / "cards" / path).write_text("mine", "utf-8")
    assert made(target, mine)[path] == "mine"


def test_a_part_may_be_included(target, mine):
    (mine / "cards" / "_part.jinja").write_text("a part\n", "utf-8")
    (mine / "cards" / "card.txt.jinja").write_text('{% include "_part.jinja" %}', "utf-8")
    assert made(target, mine)["card.txt"] == "a part\n"


def test_a_value_without_a_filter_is_an_error_in_them_too(target, mine):
    (mine / "cards" / "card.txt.jinja").write_text("first\n{{ who }}\n", "utf-8")
    with pytest.raises(MmrsError, match=r"card.txt.jinja, line 2: 'alpha' is written without a filter"):
        made(target, mine)


def test_what_fails_in_one_is_told_with_its_line(target, mine):
    (mine / "cards" / "card.txt.jinja").write_text("first\n{{ (1 / 0) | py }}\n", "utf-8")
    with pytest.raises(MmrsError, match=r"card.txt.jinja, line 2: division by zero"):
        made(target, mine)


def test_a_template_that_extends_none_is_an_error(target, mine):
    (mine / "cards" / "card.txt.jinja").write_text('{% extends "shiped/card" %}', "utf-8")
    with pytest.raises(MmrsError, match="there is no template 'shiped/card'"):
        made(target, mine)


def test_a_file_that_the_target_does_not_have_is_an_error(target, mine):
    (mine / "cards" / "cart.txt.jinja").write_text("", "utf-8")
    with pytest.raises(MmrsError, match=r"it has card\.txt\.jinja, copied\.txt, those in run/"):
        made(target, mine)


def test_a_folder_of_no_target_is_an_error(target, mine):
    (mine / "crads").mkdir()
    with pytest.raises(MmrsError, match="known are cards, other"):
        made(target, mine, others=["other"])


def test_a_folder_of_another_target_is_left_alone(target, mine):
    (mine / "other").mkdir()
    (mine / "other" / "x").write_text("", "utf-8")
    assert made(target, mine, others=["other"])["card.txt"] == 'head\n"alpha"\n'


def test_hidden_files_are_left_alone(target, mine):
    (mine / ".git").mkdir()
    (mine / "cards" / ".gitignore").write_text("*~", "utf-8")
    assert json.loads(made(target, mine)["cards.manifest.json"])["overrides"] == {}


def test_a_folder_that_is_not_there_is_unreadable(target, mine):
    with pytest.raises(UnreadableError, match="no such folder"):
        made(target, mine / "nowhere")


def test_the_manifest_says_which_files_were_replaced(target, mine):
    (mine / "cards" / "copied.txt").write_text("mine", "utf-8")
    manifest = json.loads(made(target, mine)["cards.manifest.json"])
    assert manifest["overrides"] == {"copied.txt": sha256(b"mine").hexdigest()}


@pytest.mark.parametrize("target", mmrs_targets(), ids=lambda target: target.name)
def test_every_template_of_the_core_can_be_extended(target, tmp_path):
    own = tmp_path / target.name
    own.mkdir()
    names = [path.name for path in target.templates.glob("*.jinja")]
    for name in names:
        (own / name).write_text(f'{{% extends "shipped/{name}" %}}', "utf-8")
    given = target_input(two_drones())
    replaced = render(target, given, allow_lossy=True, overrides=overrides_in(tmp_path, target))
    assert replaced[:-1] == render(target, given, allow_lossy=True)[:-1]
    assert sorted(json.loads(replaced[-1].content)["overrides"]) == sorted(names)
