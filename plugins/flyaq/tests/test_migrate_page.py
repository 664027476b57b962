"""The page about mappings names every key that mapping files have."""

import re
import tomllib
from pathlib import Path

import pytest
from mmrs_flyaq.plugin import FLYAQ_2015
from mmrs_flyaq.rules.mapping_file import read_mapping

from mmrs_core.errors import UnreadableError

PAGE = (Path(__file__).parents[3] / "docs" / "migrate.md").read_text(encoding="utf-8")
RULES, FEATURES = PAGE.split("### Rules")[1].split("### Features")
KEYS = re.compile(r"^\| `(\w+)` \|", re.MULTILINE)
OF_RULES = KEYS.findall(RULES)
OF_FEATURES = KEYS.findall(FEATURES.split("### Files")[0])
FRAME = """
[languages]
robot = "urn:mmrs:robot:1.0"
[packages]
port.uris = "urn:example:port"
[structure.port]
Boat = ["title: text"]
[rules.port.Boat]
{rule}
[rules.port.Boat.features.title]
{feature}
"""


def keys_of(rules):
    """Return the keys of rules and those of features, in the tables of a mapping file."""
    tables = [rule for package in rules.values() for rule in package.values()]
    uses = [use for rule in tables for use in rule.get("features", {}).values() if isinstance(use, dict)]
    return {key for rule in tables for key in rule}, {key for use in uses for key in use}


def test_the_page_tells_every_key_that_the_shipped_mapping_uses():
    of_rules, of_features = keys_of(tomllib.loads(FLYAQ_2015.read_text())["rules"])
    assert of_rules <= set(OF_RULES)
    assert of_features <= set(OF_FEATURES)


@pytest.mark.parametrize(
    ("rule", "feature"), [*((key, "") for key in OF_RULES), *(("", key) for key in OF_FEATURES)]
)
def test_every_key_on_the_page_is_one(contributions, tmp_path, rule, feature):
    file = tmp_path / "m.toml"
    said = {
        "rule": f"{rule} = 1979-05-27" if rule else "",
        "feature": f"{feature} = 1979-05-27" if feature else "",
    }
    file.write_text(FRAME.format(**said))
    with pytest.raises(UnreadableError) as fault:
        read_mapping(file, contributions.languages)
    assert "no such key" not in str(fault.value)
