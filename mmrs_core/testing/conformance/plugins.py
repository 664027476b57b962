"""Laws for plug-ins as a whole."""

from __future__ import annotations

import pytest

from mmrs_core.contributions.registry import Contributions
from mmrs_core.languages.uris import BEHAVIOUR, MISSION
from mmrs_core.plugins import load_plugins
from mmrs_core.testing.conformance.declared import Conformance, declared

TASK = (MISSION, "Task")
MOVE = (BEHAVIOUR, "Move")


class PluginConformance(Conformance):
    """A plug-in that works alone with the core, and leaves nothing that it brings without a meaning.

    Its ``name`` is that of its entry point.
    """

    @pytest.fixture(scope="class")
    @classmethod
    def installed(cls) -> Contributions:
        """Return what all installed plug-ins contribute."""
        return load_plugins().contributions

    def test_it_conflicts_with_nothing_in_the_core(self, alone: Contributions) -> None:
        """Names, codes and metaclasses are its own, and every metaclass that it names exists."""
        alone.check()

    def test_it_is_installed_and_conflicts_with_no_other_plugin(self, installed: Contributions) -> None:
        """The entry point leads to it, and all plug-ins that are here go together."""
        installed.check()
        assert self.name in {each.plugin for each in installed.catalogue()}

    def test_every_task_has_a_rule(self, alone: Contributions) -> None:
        """A task without a rule cannot be planned."""
        assert self._classes_of(alone, TASK) <= set(alone.rules)

    def test_every_move_has_a_kind(self, alone: Contributions) -> None:
        """A move without a kind cannot be checked, simulated or generated."""
        assert self._classes_of(alone, MOVE) <= set(alone.move_kinds)

    def test_every_task_is_drawn_on_a_map(self, alone: Contributions) -> None:
        """A task without a symbol looks like any other."""
        assert self._classes_of(alone, TASK) <= set(alone.map_symbols)

    def test_map_symbols_are_short_and_offer_fields_that_exist(self, alone: Contributions) -> None:
        """Labels are words in small letters; fields are features of the class."""
        for symbol in declared(self.plugin, "map_symbols"):
            features = {feature.name for feature in alone.languages.metaclass(*symbol.metaclass).features}
            assert set(symbol.fields) <= features
            assert symbol.icon
            assert symbol.label == symbol.label.lower()

    def _classes_of(self, contributions: Contributions, base: tuple[str, str]) -> set[tuple[str, str]]:
        own = {source.ns_uri for source in declared(self.plugin, "metamodels")}
        return {
            metaclass.key
            for package in contributions.languages.packages
            if package.ns_uri in own
            for metaclass in package.metaclasses
            if metaclass.implementation and metaclass.is_kind(*base)
        }
