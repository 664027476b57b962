"""Hypothesis strategies for models: random valid instances of any metamodel."""

from __future__ import annotations

from hypothesis import strategies as st

from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import Metaclass
from mmrs_core.languages.registry import Registry
from mmrs_core.testing.growth import Growth
from mmrs_core.testing.kinds import Kinds, all_kinds, fits, kinds_below, kinds_of
from mmrs_core.testing.strategies import Values

_NO_ELEMENT = "{}#{}: no class that elements can be made of"


def instances_of(
    registry: Registry, ns_uri: str, name: str = "", *, levels: int = 2, values: Values | None = None
) -> st.SearchStrategy[Element]:
    """Draw valid elements of a metaclass, with random contents.

    What is drawn conforms to the metamodel: bounds, types, opposites and identifiers are right, and
    references lead to elements inside the tree. Constraints beyond the metamodel may well be broken.

    Args:
        registry: the metamodels.
        ns_uri: of the metamodel whose class is wanted.
        name: of the class; instances of its subclasses are drawn as well. Empty: any class of the
            metamodel whose elements are valid alone.
        levels: of containment that are filled at random; below, only what must be is there.
        values: strategies for data types by (nsURI, name), where any text would not do.

    Raises:
        ValueError: if there is no such class, or none of its elements can be valid alone.
    """
    roots = _roots(registry, ns_uri, name)

    @st.composite
    def tree(draw: st.DrawFn) -> Element:
        root = draw(st.sampled_from(sorted(roots, key=lambda each: each.key)))
        return Growth(draw, roots[root], levels, values).forest([root])[0]

    return tree()


def drafts_of(
    registry: Registry, ns_uri: str, name: str = "", *, levels: int = 2, values: Values | None = None
) -> st.SearchStrategy[Element]:
    """Draw elements of a metaclass that may be incomplete, as models are while they are being edited.

    Values are of their types and references lead into the tree, but anything that must be there may be
    missing.

    Args:
        registry: the metamodels.
        ns_uri: of the metamodel whose class is wanted.
        name: of the class; those of its subclasses are drawn as well. Empty: any class of the metamodel.
        levels: as for `instances_of`.
        values: as for `instances_of`.

    Raises:
        ValueError: if there is no such class, or no element can be of it.
    """
    candidates = sorted(_candidates(registry, ns_uri, name), key=lambda each: each.key)
    if not candidates:
        raise ValueError(_NO_ELEMENT.format(ns_uri, name))
    kinds = kinds_of(tuple(all_kinds(registry)))

    @st.composite
    def tree(draw: st.DrawFn) -> Element:
        root = draw(st.sampled_from(candidates))
        return Growth(draw, kinds, levels, values, whole=False).forest([root])[0]

    return tree()


def models_of(
    registry: Registry, *roots: tuple[str, str], levels: int = 2, values: Values | None = None
) -> st.SearchStrategy[tuple[Element, ...]]:
    """Draw valid models whose roots are of these metaclasses, as `instances_of` does.

    References lead from each tree into all of them, so that elements can be drawn that are not valid
    without others beside them.

    Args:
        registry: the metamodels.
        roots: nsURI and name of the class of each root, in order.
        levels: as for `instances_of`.
        values: as for `instances_of`.

    Raises:
        ValueError: if there is no such class, or no valid model.
    """
    metaclasses = [registry.metaclass(*root) for root in roots]
    kinds = kinds_below(registry, *metaclasses)

    @st.composite
    def forest(draw: st.DrawFn) -> tuple[Element, ...]:
        return Growth(draw, kinds, levels, values).forest(metaclasses)

    return forest()


def _candidates(registry: Registry, ns_uri: str, name: str) -> list[Metaclass]:
    if not name:
        return [kind for kind in registry.package(ns_uri).metaclasses if kind.implementation]
    wanted = registry.metaclass(ns_uri, name)
    return [kind for kind in all_kinds(registry) if fits(kind, wanted, ns_uri)]


def _roots(registry: Registry, ns_uri: str, name: str) -> dict[Metaclass, Kinds]:
    found, reason = {}, _NO_ELEMENT.format(ns_uri, name)
    for kind in _candidates(registry, ns_uri, name):
        try:
            found[kind] = kinds_below(registry, kind)
        except ValueError as fault:
            reason = str(fault)
    if not found:
        raise ValueError(reason)
    return found
