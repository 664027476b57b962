"""The target that a new plug-in begins with writes or refuses whatever robots need."""

import sys
from dataclasses import replace
from importlib import import_module, invalidate_caches

import pytest

from mmrs_core.generation.capabilities.judging import capabilities_of, lost
from mmrs_core.generation.scaffolding.files import write_plugin
from mmrs_core.generation.scaffolding.names import plugin_names
from mmrs_core.testing.programs import installed


@pytest.fixture(scope="module")
def target(tmp_path_factory):
    folder = tmp_path_factory.mktemp("new") / "plugin"
    write_plugin(plugin_names("hull-cards"), ("target",), "point", folder)
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(str(folder))
        invalidate_caches()
        yield import_module("mmrs_hull_cards.target").TARGET
    for name in [each for each in sys.modules if each.startswith("mmrs_hull_cards")]:
        del sys.modules[name]


@pytest.mark.parametrize("vehicle", ["ground", "copter", "sub"])
def test_it_loses_nothing_silently(target, vehicle):
    made = replace(target, tried_with=vehicle)
    rows = capabilities_of(made, installed())
    assert lost(made, rows) == ()
    verdicts = {row.element: row.verdict for row in rows}
    for element in (
        "TakeOff",
        "TakeOff.altitude",
        "Land",
        "DeviceAction.parameters",
        "Feedback",
        "GoTo.distance",
    ):
        assert verdicts[element] == "expressed"
    for element in (
        "UnicastNotify",
        "MoveTransition.waitFor",
        "HeadTo.heading",
        "Recharge",
        "LINK_LOST: HOLD",
    ):
        assert verdicts[element] == "lossy"
