from pathlib import Path

import pytest

from mmrs_core.errors import UsageError
from mmrs_mavlink.plugin.backend.options import LinkOptions, link_options


def test_options_are_read_by_their_keys():
    given = {"home-tolerance": "5", "tries": "9", "fence": "no", "signing-key": "k", "inject": "loss=0.1"}
    expected = LinkOptions(home_tolerance=5.0, tries=9, fence=False, signing_key=Path("k"), inject="loss=0.1")
    assert link_options(given) == expected


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("accepptance", "1"),
        ("acceptance", "0"),
        ("acceptance", "near"),
        ("patience", "inf"),
        ("tries", "0"),
        ("tries", "1.5"),
        ("fence", "maybe"),
        ("objects", "guessed"),
    ],
)
def test_what_makes_no_sense_is_refused_by_its_key(key, value):
    with pytest.raises(UsageError, match=f"option '{key}'"):
        link_options({key: value})
