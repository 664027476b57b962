"""The effect of metamodel changes on models of the older version."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import Enum

from mmrs_core.languages.datatypes import ECORE, XML_TYPES, DataType
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass


class Effect(Enum):
    """Whether older models still load."""

    COMPATIBLE = "compatible"
    MEANING = "changed meaning"
    INCOMPATIBLE = "incompatible"


@dataclass(frozen=True, slots=True)
class Difference:
    """One change of a metamodel.

    Attributes:
        sort: added, removed or changed.
        what: the class, ``Class.feature`` or ``Enumeration.literal``.
        verdict: whether older models load as before.
        words: what is different.
        reason: why older models do not load, or mean something else; may be empty where they do.
    """

    sort: str
    what: str
    verdict: Effect
    words: str
    reason: str = ""


def changed(what: str, words: str, verdict: Effect = Effect.COMPATIBLE, reason: str = "") -> Difference:
    """Return a change of something that both versions have."""
    return Difference("changed", what, verdict, words, reason)


def refused(what: str, words: str, reason: str) -> Difference:
    """Return a change by which older models do not load any more."""
    return Difference("changed", what, Effect.INCOMPATIBLE, words, reason)


Image = Callable[[tuple[str, str]], tuple[str, str]]
"""From (nsURI, name) of a class of the older version to that in the newer one."""

_BITS = {"EByte": 8, "EShort": 16, "EInt": 32, "ELong": 64, "EBigInteger": 1000}

_OF_JAVA = {
    "byte": "EByte",
    "Byte": "EByte",
    "short": "EShort",
    "Short": "EShort",
    "int": "EInt",
    "Integer": "EInt",
    "long": "ELong",
    "Long": "ELong",
    "float": "EFloat",
    "Float": "EFloat",
    "double": "EDouble",
    "Double": "EDouble",
    "boolean": "EBoolean",
    "Boolean": "EBoolean",
    "java.math.BigInteger": "EBigInteger",
    "java.math.BigDecimal": "EBigDecimal",
}


def feature_differences(what: str, old: Feature, new: Feature, image: Image) -> Iterator[Difference]:
    """Yield what is different about a feature that both versions have."""
    if old.is_reference != new.is_reference:
        sorts = ("an attribute", "a reference")
        words = f"{sorts[old.is_reference]} became {sorts[new.is_reference]}"
        yield refused(what, words, "values cannot be read as elements, nor elements as values")
        return
    if old.containment != new.containment:
        now = "contains" if new.containment else "only refers to"
        yield refused(what, f"now {now} its elements", "older models hold them the other way")
        return
    yield from _types(what, old, new, image)
    yield from _bounds(what, old, new)
    yield from _defaults(what, old, new)
    yield from _flags(what, old, new)


def _types(what: str, old: Feature, new: Feature, image: Image) -> Iterator[Difference]:
    ours, theirs = image((old.type.ns_uri, old.type.name)), (new.type.ns_uri, new.type.name)
    if ours == theirs and _made_of(old) == _made_of(new):
        return
    before, now = (old.type.name, new.type.name) if ours != theirs else (_made_of(old), _made_of(new))
    words = f"its type was {before}, is {now}"
    if isinstance(old.type, Metaclass) and isinstance(new.type, Metaclass):
        yield _class_change(what, words, old, new, ours)
    elif _may_hold_nothing(old) and not _may_hold_nothing(new):
        yield refused(what, words, f"older models may say nil, which is no {now}")
    elif _widens(old.type, new.type):
        yield changed(what, words)
    else:
        yield refused(what, words, f"not every {before} can be read as {now}")


def _made_of(feature: Feature) -> str:
    """Return what the type of a feature is in Java, whatever it is called."""
    if isinstance(feature.type, DataType):
        return feature.type.java_class
    return "an enumeration" if isinstance(feature.type, Enumeration) else "a class"


def _may_hold_nothing(feature: Feature) -> bool:
    """Return whether EMF writes nil for some values: among many, or where nothing is not the default."""
    if isinstance(feature.type, DataType) and feature.type.primitive:
        return False
    return feature.many or feature.unsettable or feature.default is not None


def _class_change(what: str, words: str, old: Feature, new: Feature, ours: tuple[str, str]) -> Difference:
    assert isinstance(old.type, Metaclass)
    assert isinstance(new.type, Metaclass)
    known = next((kind for kind in _kinds_around(new) if kind.key == ours), None)
    if known is None or not issubclass(known.interface, new.type.interface):
        return refused(what, words, f"a {old.type.name} is no {new.type.name}")
    if old.containment and not old.type.abstract:
        reason = f"elements that do not say their class would be read as {new.type.name}"
        return refused(what, words, reason)
    return changed(what, words)


def _kinds_around(feature: Feature) -> Iterator[Metaclass]:
    package = feature.owner.package
    for known in package.known.values() if package is not None else ():
        yield from known.metaclasses


def _widens(old: object, new: object) -> bool:
    """Return whether every value of one type is written as a value of another, with the same meaning."""
    if not isinstance(new, DataType):
        return False
    if new.python is str and new.java_class not in ("char", "java.lang.Character"):
        return not (isinstance(old, DataType) and old.java_class in ("char", "java.lang.Character"))
    if isinstance(old, Enumeration) or not isinstance(old, DataType):
        return False
    ours, theirs = _plain(old), _plain(new)
    if ours == theirs:
        return True
    if ours in _BITS:
        return _BITS[ours] <= _BITS.get(theirs, 0) or theirs in ("EDouble", "EBigDecimal")
    return (ours, theirs) == ("EFloat", "EDouble")


def _plain(kind: DataType) -> str:
    """Return Ecore's name of a type, without what says that its values may be null."""
    if kind.ns_uri not in (ECORE, XML_TYPES):
        return _OF_JAVA.get(kind.java_class.removeprefix("java.lang."), kind.java_class)
    return {"EIntegerObject": "EInt"}.get(kind.name, kind.name.removesuffix("Object"))


def _bounds(what: str, old: Feature, new: Feature) -> Iterator[Difference]:
    if (old.lower, old.most) == (new.lower, new.most):
        return
    words = f"takes {_range(new)}, took {_range(old)}"
    if new.lower > old.lower and not (new.default is not None and not new.many):
        yield refused(what, words, f"older models may have fewer than {new.lower}")
    elif 0 <= new.most < old.most or (old.most < 0 <= new.most):
        yield refused(what, words, f"older models may have more than {new.most}")
    elif new.many and not old.many and not new.is_reference and getattr(new.type, "python", str) is str:
        yield refused(what, words, "texts with blanks would be read as several values")
    else:
        yield changed(what, words)


def _range(feature: Feature) -> str:
    if feature.most < 0:
        return f"{feature.lower} or more"
    return str(feature.lower) if feature.lower == feature.most else f"{feature.lower} to {feature.most}"


def _defaults(what: str, old: Feature, new: Feature) -> Iterator[Difference]:
    if old.is_reference or old.many or new.many or _same(old.default, new.default):
        return
    words = f"its default was {_shown(old)}, is {_shown(new)}"
    yield changed(what, words, Effect.MEANING, "older models that leave it out mean something else now")


def _same(ours: object, theirs: object) -> bool:
    """Return whether defaults mean the same: 0 and 0.0 do, null and 0 do not."""
    numbers = isinstance(ours, int | float) and isinstance(theirs, int | float)
    return ours == theirs if numbers else repr(ours) == repr(theirs)


def _shown(feature: Feature) -> str:
    if feature.default is None or isinstance(feature.type, Metaclass):
        return "none"
    return repr(feature.type.render(feature.default))


def _flags(what: str, old: Feature, new: Feature) -> Iterator[Difference]:
    if old.is_id and not new.is_id:
        yield refused(what, "identifies its element no longer", "references by this id lead nowhere")
    if new.is_id and not old.is_id:
        yield refused(what, "identifies its element now", "older models may have it twice")
    if new.unique and not old.unique and new.many:
        yield refused(what, "holds a value only once now", "older models may hold one twice")
    if new.many and new.keys and not (old.keys and set(old.keys) <= set(new.keys)):
        yield refused(what, f"tells its elements apart by {', '.join(new.keys)} now", "two may be alike")
    if old.stored and not new.stored:
        yield changed(what, "is not written any more", Effect.MEANING, "it is lost when a model is saved")
    if old.unsettable and not new.unsettable:
        yield changed(
            what, "cannot be unset any more", Effect.MEANING, "a stated default now counts as unset"
        )
    yield from _other_ends(what, old, new)


def _other_ends(what: str, old: Feature, new: Feature) -> Iterator[Difference]:
    before, now = old.opposite, new.opposite
    if now is not None and before is None:
        words = f"has {now.name} as its other end now"
        is_new = isinstance(old.type, Metaclass) and now.name not in old.type.by_name
        if is_new and (now.many or new.containment):
            yield changed(what, words)  # reading sets the other end
        else:
            yield refused(what, words, "older models may contradict it")
    elif before is not None and now is None and _has(new, before.name):
        reason = "older models may state one of the two only"
        yield changed(what, f"has {before.name} as its other end no longer", Effect.MEANING, reason)


def _has(feature: Feature, name: str) -> bool:
    return isinstance(feature.type, Metaclass) and name in feature.type.by_name
