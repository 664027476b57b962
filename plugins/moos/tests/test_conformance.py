from mmrs_moos import plugin

from mmrs_core.testing.conformance import PluginConformance, TargetConformance
from mmrs_core.testing.programs import sample_of


class TestPlugin(PluginConformance):
    plugin = plugin
    name = "moos"


class TestTargets(TargetConformance):
    plugin = plugin
    inputs = {"moos": sample_of("auv").plain}
