from itertools import combinations

import mmrs_auv.plugin
import mmrs_multicopter.plugin
import mmrs_rover.plugin
import mmrs_survey.plugin
import pytest

from mmrs_core.languages.missing import stem_of
from mmrs_core.plugins import load_plugins

ALL = {
    "auv": mmrs_auv.plugin,
    "multicopter": mmrs_multicopter.plugin,
    "rover": mmrs_rover.plugin,
    "survey": mmrs_survey.plugin,
}
SUBSETS = [names for count in range(len(ALL) + 1) for names in combinations(ALL, count)]


@pytest.mark.parametrize("names", SUBSETS, ids=lambda names: "+".join(names) or "none")
def test_plugins_work_with_any_of_the_others_absent(names):
    found = load_plugins(only_core=True, extra={name: ALL[name] for name in names}).contributions
    installed = {stem_of(package.ns_uri) for package in found.languages.packages}
    assert {f"urn:mmrs:{name}" in installed for name in names} <= {True}
    assert {each.plugin for each in found.catalogue()} == {"core", *names}


def test_a_plugin_brings_nothing_to_others_languages():
    everything = load_plugins(only_core=True, extra=ALL).contributions.languages
    core = load_plugins(only_core=True).contributions.languages
    for package in core.packages:
        assert [each.key for each in everything.package(package.ns_uri).metaclasses] == [
            each.key for each in package.metaclasses
        ]
