"""What a pyecore EPackage says, as the same tables that an .ecore file gives."""

from __future__ import annotations

from typing import Any

from pyecore import ecore

from mmrs_core.errors import PluginError
from mmrs_core.languages.metaclass import Literal
from mmrs_core.languages.metamodels.nodes import GENMODEL
from mmrs_core.languages.metamodels.tables import (
    ClassTable,
    DataTypeTable,
    EnumTable,
    FeatureTable,
    PackageTable,
)


def package_table(package: object) -> PackageTable:
    """Return the tables of an EPackage.

    Raises:
        PluginError: if it is no EPackage, or lacks its name or nsURI.
    """
    if not isinstance(package, ecore.EPackage):
        raise PluginError(f"{package!r}: neither the path of an .ecore file nor a pyecore EPackage")
    if not package.name or not package.nsURI:
        raise PluginError(f"EPackage {package.name or '?'}: name or nsURI is missing")
    classifiers: list[Any] = list(package.eClassifiers)
    return PackageTable(
        package.nsURI,
        package.name,
        package.nsPrefix or package.name,
        _documentation(package),
        tuple(_class(kind) for kind in classifiers if isinstance(kind, ecore.EClass)),
        tuple(_enum(kind) for kind in classifiers if isinstance(kind, ecore.EEnum)),
        tuple(_datatype(kind) for kind in classifiers if type(kind) is ecore.EDataType),
        tuple(package_table(inner) for inner in package.eSubpackages),
    )


def _class(kind: Any) -> ClassTable:
    return ClassTable(
        kind.name,
        bool(kind.abstract or kind.interface),
        _documentation(kind),
        tuple(_uri(above) for above in kind.eSuperTypes),
        tuple(_feature(feature) for feature in kind.eStructuralFeatures),
        kind.instanceClassName or "",
    )


def _feature(feature: Any) -> FeatureTable:
    is_reference = isinstance(feature, ecore.EReference)
    opposite = feature.eOpposite if is_reference else None
    keys = getattr(feature, "eKeys", ())  # pyecore 0.15 knows none
    return FeatureTable(
        name=feature.name,
        type="" if feature.eType is None else _uri(feature.eType),
        is_reference=is_reference,
        documentation=_documentation(feature),
        lower=feature.lowerBound,
        upper=feature.upperBound,
        containment=is_reference and bool(feature.containment),
        unsettable=bool(feature.unsettable),
        unique=bool(feature.unique),
        is_id=not is_reference and bool(feature.iD),
        stored=not feature.transient,
        default=feature.defaultValueLiteral,
        opposite=f"{_uri(opposite.eContainer())}/{opposite.name}" if opposite is not None else "",
        keys=tuple(f"{_uri(key.eContainer())}/{key.name}" for key in keys),
    )


def _enum(kind: Any) -> EnumTable:
    literals = (
        Literal(
            literal.name,
            literal.literal if getattr(literal, "literal", None) else literal.name,
            literal.value,
            _documentation(literal),
        )
        for literal in kind.eLiterals
    )
    return EnumTable(kind.name, tuple(literals), _documentation(kind))


def _datatype(kind: Any) -> DataTypeTable:
    java_class = kind.instanceClassName or ""
    return DataTypeTable(kind.name, java_class, bool(kind.serializable), _documentation(kind))


def _uri(classifier: Any) -> str:
    """Return nsURI and name of a classifier; classes of Ecore itself are among them."""
    package = classifier.ePackage
    return f"{package.nsURI}#//{classifier.name}"


def _documentation(element: Any) -> str:
    annotation = element.getEAnnotation(GENMODEL)
    if annotation is None:
        return ""
    text = annotation.details.get("documentation")
    return text if isinstance(text, str) else ""
