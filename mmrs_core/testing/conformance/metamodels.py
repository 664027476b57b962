"""Laws for metamodels."""

from __future__ import annotations

from pathlib import Path

from hypothesis import given
from hypothesis import strategies as st

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.registry import MetamodelSource, Registry
from mmrs_core.languages.writing import to_xmi
from mmrs_core.testing.conformance.declared import Conformance, declared, law
from mmrs_core.testing.instances import instances_of
from mmrs_core.testing.kinds import kinds_below


class MetamodelConformance(Conformance):
    """Every metamodel of a plug-in is one that models can be made of, kept in files and read about."""

    def test_there_is_a_metamodel(self) -> None:
        """A plug-in whose metamodels are tested has one."""
        assert self._sources()

    def test_metamodels_are_files_that_hold_what_they_announce(self, registry: Registry) -> None:
        """Each comes from a file of the plug-in, under its nsURI."""
        for source in self._sources():
            assert isinstance(source.ecore, Path)
            assert source.ecore.is_file()
            assert registry.package(source.ns_uri).ecore == source.ecore

    def test_every_class_and_feature_is_documented(self, registry: Registry) -> None:
        """Editors and the page about the languages show the documentation."""
        undocumented = [
            f"{metaclass.name}{feature and '.' + feature}"
            for metaclass in self._metaclasses(registry)
            for feature, text in _texts(metaclass)
            if not text
        ]
        assert undocumented == []

    def test_every_real_number_is_a_double(self, registry: Registry) -> None:
        """Numbers keep all their bits."""
        for metaclass in self._metaclasses(registry):
            assert not [each.name for each in metaclass.features if each.type.name == "EFloat"]

    def test_random_models_are_valid_and_survive_in_files(self, registry: Registry) -> None:
        """What is written is read back as the same valid model."""
        alone = [each for each in self._metaclasses(registry) if _stands_alone(registry, each)]

        @law(examples=25)
        @given(st.one_of([instances_of(registry, *each.key) for each in alone]))
        def holds(root: Element) -> None:
            assert check_conformance(Model("m", (root,)), registry) == ()
            text = to_xmi([root], registry)
            again = read_text(text, "again.xmi", registry)
            assert again.diagnostics == ()
            assert to_xmi(again.roots, registry) == text

        if alone:
            holds()

    def _sources(self) -> tuple[MetamodelSource, ...]:
        return declared(self.plugin, "metamodels")

    def _metaclasses(self, registry: Registry) -> list[Metaclass]:
        packages = [registry.package(source.ns_uri) for source in self._sources()]
        return [metaclass for package in packages for metaclass in package.metaclasses]


def _texts(metaclass: Metaclass) -> list[tuple[str, str]]:
    own = [feature for feature in metaclass.features if feature.owner is metaclass]
    return [("", metaclass.documentation), *((each.name, each.documentation) for each in own)]


def _stands_alone(registry: Registry, metaclass: Metaclass) -> bool:
    if metaclass.implementation is None:
        return False
    try:
        kinds_below(registry, metaclass)
    except ValueError:
        return False
    return True
