from __future__ import annotations

from mmrs_imc import plugin

from mmrs_core.generation.capabilities.probes import plain
from mmrs_core.testing.conformance import PluginConformance, TargetConformance


class TestPlugin(PluginConformance):
    plugin = plugin
    name = "imc"


class TestTargets(TargetConformance):
    plugin = plugin
    inputs = {"imc": plain("sub")}
