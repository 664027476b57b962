from mmrs_imc import plugin

from mmrs_core.testing.conformance import PluginConformance, TargetConformance
from mmrs_core.testing.programs import sample_of


class TestPlugin(PluginConformance):
    plugin = plugin
    name = "imc"


class TestTargets(TargetConformance):
    plugin = plugin
    inputs = {"imc": sample_of("auv").plain}
