"""The conformance classes find faulty contributions, and load what a plug-in builds on without testing it."""

from __future__ import annotations

from types import SimpleNamespace

import pytest
from mmrs_multicopter import plugin as multicopter

from mmrs_core.contributions.rules import MoveKind
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.sources import MetamodelSource
from mmrs_core.testing.conformance import MetamodelConformance, PluginConformance
from mmrs_core.transformation.kinds import no_time, stays

BALLOON = "urn:mmrs:testing:balloon:1.0"
ECORE = f"""<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore"
    name="balloon" nsURI="{BALLOON}" nsPrefix="balloon">
  <eClassifiers xsi:type="ecore:EClass" name="Release" eSuperTypes="urn:mmrs:multicopter:1.0#//TakeOff">
    <eAnnotations source="http://www.eclipse.org/emf/2002/GenModel">
      <details key="documentation" value="Releases the rope."/>
    </eAnnotations>
  </eClassifiers>
</ecore:EPackage>
"""


@pytest.fixture
def balloons(tmp_path):
    """Return a plug-in whose move extends a move of another plug-in."""
    file = tmp_path / "balloon.ecore"
    file.write_text(ECORE)
    kind = MoveKind((BALLOON, "Release"), stays, no_time, frozenset({"grounded"}))
    return SimpleNamespace(
        mmrs_metamodels=hookimpl(lambda: (MetamodelSource(BALLOON, file, "balloons"),)),
        mmrs_move_kinds=hookimpl(lambda: (kind,)),
    )


def kit_for(plugin, base, **attributes):
    """Return a conformance class for a plug-in, as a test module would have it."""
    return type("Tested", (base,), {"plugin": plugin, "name": "balloons", **attributes})


@pytest.mark.parametrize(
    "more",
    [{"more_plugins": (multicopter,)}, {"more_metamodels": tuple(multicopter.mmrs_metamodels())}],
    ids=["plugins", "metamodels"],
)
def test_what_a_plugin_builds_on_is_loaded_and_not_tested(balloons, more):
    kit = kit_for(balloons, PluginConformance, **more)
    kit().test_it_conflicts_with_nothing_in_the_core(kit.with_core())
    kit().test_every_move_has_a_kind(kit.with_core())


def test_a_missing_metamodel_is_named_with_what_loads_it(balloons):
    with pytest.raises(pytest.fail.Exception, match=r"multicopter:1\.0.*more_plugins"):
        kit_for(balloons, MetamodelConformance).with_core()
