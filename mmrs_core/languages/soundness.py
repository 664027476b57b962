"""Functions compiled for metaclasses, which tell of most elements that they obey it beyond doubt.

They decide nothing else: where they doubt, the rules of `conformance` are asked, which have words for it.
As for the reader, no text of a metamodel or a model gets into the source: slots are numbered, all else is
bound.
"""

from __future__ import annotations

from collections.abc import Callable

from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass
from mmrs_core.languages.metamodels.classes import bare_name
from mmrs_core.languages.values.real import LARGEST_SINGLE, render_real, render_single

Stands = Callable[[Element], bool]
Sound = Callable[[Element, Stands], bool]
"""Whether an element is sound, given a function that tells whether another one stands in a model."""


def soundness(metaclass: Metaclass) -> Sound:
    """Return the function for elements of exactly that metaclass."""
    if "soundness" not in metaclass.compiled:
        metaclass.compiled["soundness"] = _compiled(metaclass)
    return metaclass.compiled["soundness"]  # type: ignore[return-value]  # the line above put it there


def _compiled(metaclass: Metaclass) -> Sound:
    bound: dict[str, object] = {}
    lines = []
    for index, feature in enumerate(metaclass.features):
        bound[f"f{index}"] = feature
        lines += [f"v = e.{bare_name(index)}", *_checks(index, feature, bound)]
    source = "\n    ".join(["def sound(e, stands):", *lines, "return True"])
    exec(compile(source, f"<soundness of {metaclass.name}>", "exec"), bound)  # noqa: S102  # no foreign text in it
    made: Sound = bound["sound"]  # type: ignore[assignment]  # the source above defines it
    return made


def _checks(index: int, feature: Feature, bound: dict[str, object]) -> list[str]:
    """Return the lines that return False unless the value ``v`` of a feature is sound."""
    if (
        feature.is_id
        or feature.keys
        or feature.opposite is not None
        or (feature.many and not feature.is_reference)
    ):
        return [
            "return False" if feature.lower else f"if v{'' if feature.many else ' is not None'}: return False"
        ]
    if feature.is_reference:
        return _reference(index, feature, bound)
    needed = feature.required and feature.default is None
    missing = f"if v is None: {'return False' if needed else 'pass'}"
    return [missing, f"elif not ({_usual(index, feature, bound)}): return False"]


def _usual(index: int, feature: Feature, bound: dict[str, object]) -> str:
    """Return the expression that is true for values of the usual class."""
    kind = feature.type
    assert not isinstance(kind, Metaclass)  # it is an attribute
    if isinstance(kind, Enumeration):
        bound[f"k{index}"] = frozenset(kind.names)
        return f"v.__class__ is str and v in k{index}"
    if kind.render is render_real:
        return "v.__class__ is float and v - v == 0.0"  # neither infinite nor no number
    if kind.render is render_single:
        return f"v.__class__ is float and -{LARGEST_SINGLE!r} <= v <= {LARGEST_SINGLE!r}"
    if kind.bits is not None:
        return f"v.__class__ is int and {-(1 << kind.bits - 1)} <= v < {1 << kind.bits - 1}"
    if kind.render is str or kind.python is bool:
        return f"v.__class__ is {kind.python.__name__}"
    return "False"


def _reference(index: int, feature: Feature, bound: dict[str, object]) -> list[str]:
    bound[f"k{index}"] = feature.type.interface  # type: ignore[union-attr]  # a reference has a class
    if feature.containment:
        good = f"isinstance(x, k{index}) and x._mmrs_container is e and x._mmrs_feature is f{index}"
    else:
        good = f"isinstance(x, k{index}) and stands(x)"
    if not feature.many:
        needed = "return False" if feature.required else "pass"
        return [f"if v is None: {needed}", "else:", "    x = v", f"    if not ({good}): return False"]
    lines = [f"if v is None: {'return False' if feature.lower else 'pass'}", "else:"]
    lines.append(f"    if len(v) < {feature.lower}: return False")
    if feature.upper > 0:
        lines.append(f"    if len(v) > {feature.upper}: return False")
    if feature.unique:
        lines.append("    if len(set(v)) < len(v): return False")
    return [*lines, "    for x in v:", f"        if not ({good}): return False"]
