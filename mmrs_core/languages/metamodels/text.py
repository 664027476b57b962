"""The text of an .ecore file for a package that has none, because it was made with pyecore."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from mmrs_core.languages.datatypes import ECORE, DataType
from mmrs_core.languages.metaclass import MAP_ENTRY, Enumeration, Feature, Metaclass, Package
from mmrs_core.languages.metamodels.ecore_file import GENMODEL
from mmrs_core.languages.xmi.escapes import in_attribute
from mmrs_core.languages.xmi.events import XMI, XSI

Address = Callable[[str], str]
"""From an nsURI to what stands before the name of one of its classes, such as ``mission.ecore#//``."""


def package_text(package: Package, address: Address) -> str:
    """Return a package, with those inside it, as an .ecore file."""
    head = (
        ("xmi:version", "2.0"),
        ("xmlns:xmi", XMI),
        ("xmlns:xsi", XSI),
        ("xmlns:ecore", ECORE),
        *_names(package),
    )
    body = _package_body(package, address)
    return (
        '<?xml version="1.0" encoding="UTF-8"?>\n' + "\n".join(_element("ecore:EPackage", head, body)) + "\n"
    )


def _names(package: Package) -> tuple[tuple[str, str], ...]:
    return ("name", package.name), ("nsURI", package.ns_uri), ("nsPrefix", package.prefix)


def _package_body(package: Package, address: Address) -> list[str]:
    body = _documentation(package.documentation)
    for enumeration in package.enumerations:
        body += _enumeration(enumeration)
    for datatype in package.datatypes:
        kind = (
            ("xsi:type", "ecore:EDataType"),
            ("name", datatype.name),
            ("instanceClassName", datatype.java_class),
            *(() if datatype.serializable else (("serializable", "false"),)),
        )
        body += _element("eClassifiers", kind, [])
    for metaclass in package.metaclasses:
        body += _class(metaclass, address)
    for inner in package.known.values():
        if inner.parent == package.ns_uri:
            body += _element("eSubpackages", _names(inner), _package_body(inner, address))
    return body


def _enumeration(enumeration: Enumeration) -> list[str]:
    body = _documentation(enumeration.documentation)
    for literal in enumeration.literals:
        attributes = (("name", literal.name), ("value", str(literal.value)), ("literal", literal.literal))
        body += _element("eLiterals", attributes, _documentation(literal.documentation))
    return _element("eClassifiers", (("xsi:type", "ecore:EEnum"), ("name", enumeration.name)), body)


def _class(metaclass: Metaclass, address: Address) -> list[str]:
    supertypes = " ".join(f"{address(above.ns_uri)}{above.name}" for above in metaclass.supertypes)
    attributes = [("xsi:type", "ecore:EClass"), ("name", metaclass.name)]
    attributes += [("abstract", "true")] if metaclass.abstract else []
    attributes += [("eSuperTypes", supertypes)] if supertypes else []
    attributes += [("instanceClassName", MAP_ENTRY)] if metaclass.is_entry else []
    body = _documentation(metaclass.documentation)
    for feature in metaclass.features:
        if feature.owner is metaclass:
            body += _feature(feature, address)
    return _element("eClassifiers", attributes, body)


def _feature(feature: Feature, address: Address) -> list[str]:
    kind = feature.type
    meta = "EClass" if feature.is_reference else "EEnum" if isinstance(kind, Enumeration) else "EDataType"
    flags = {
        "unique": (feature.unique, True),
        "transient": (not feature.stored, False),
        "unsettable": (feature.unsettable, False),
        "containment": (feature.containment, False),
        "iD": (feature.is_id, False),
    }
    attributes = [
        ("xsi:type", f"ecore:{'EReference' if feature.is_reference else 'EAttribute'}"),
        ("name", feature.name),
        ("lowerBound", str(feature.lower)),
        ("upperBound", str(feature.upper)),
        ("eType", f"ecore:{meta} {address(kind.ns_uri)}{kind.name}"),
        *((name, str(value).lower()) for name, (value, usual) in flags.items() if value is not usual),
    ]
    if feature.default is not None and isinstance(kind, (DataType, Enumeration)):
        attributes.append(("defaultValueLiteral", kind.render(feature.default)))
    if feature.opposite is not None:
        owner = feature.opposite.owner
        attributes.append(("eOpposite", f"{address(owner.ns_uri)}{owner.name}/{feature.opposite.name}"))
    if feature.keys and isinstance(kind, Metaclass) and not kind.is_entry:
        owners = ((kind.by_name[name].owner, name) for name in feature.keys)
        keys = " ".join(f"{address(owner.ns_uri)}{owner.name}/{name}" for owner, name in owners)
        attributes.append(("eKeys", keys))
    return _element("eStructuralFeatures", attributes, _documentation(feature.documentation))


def _documentation(text: str) -> list[str]:
    if not text:
        return []
    details = _element("details", (("key", "documentation"), ("value", text)), [])
    return _element("eAnnotations", (("source", GENMODEL),), details)


def _element(tag: str, attributes: Iterable[tuple[str, str]], body: list[str]) -> list[str]:
    head = "".join(f' {name}="{in_attribute(value)}"' for name, value in attributes)
    if not body:
        return [f"<{tag}{head}/>"]
    return [f"<{tag}{head}>", *(f"  {line}" for line in body), f"</{tag}>"]
