"""Metaclasses as pyecore knows them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from inspect import isdatadescriptor
from typing import Any

from pyecore import ecore

from mmrs_core.errors import InternalError
from mmrs_core.languages.datatypes import ECORE, XML_TYPES, DataType
from mmrs_core.languages.metaclass import Enumeration, Feature, Literal, Metaclass, Package
from mmrs_core.languages.metamodels.nodes import GENMODEL

_OWN_ECORE = frozenset(("EStringToStringMapEntry",))
"""Classes of Ecore that pyecore has as data types only."""

_KEPT = frozenset(
    ("__class__", "_staticEClass", *(name for name, held in vars(type).items() if isdatadescriptor(held)))
)
"""Names that Python or pyecore keeps for every class itself, so that it cannot hold a feature there."""


def epackage_of(package: Package) -> Any:
    """Return a package as a pyecore ``EPackage``, always the same object.

    It is the one that a plug-in handed in, or one made of the tables; so are the packages that it refers to.
    """
    if package.pyecore is None:
        with _usual_order():
            _build(package)
    return package.pyecore


def eclass_of(metaclass: Metaclass) -> Any:
    """Return a metaclass as a pyecore ``EClass``, always the same object."""
    if metaclass.ns_uri == ECORE and metaclass.name not in _OWN_ECORE:
        return _of_ecore(metaclass)
    if metaclass.package is None:
        raise InternalError(f"{metaclass.name}: a metaclass without a package")
    return _classifier(epackage_of(metaclass.package), metaclass.name)


@contextmanager
def _usual_order() -> Iterator[None]:
    """Undo what pyecore does to all its classes where Python has no order for the supertypes of one.

    It is needed while the bases of that class are set, and not afterwards.
    """
    before = "mro" in vars(ecore.Metasubinstance)
    try:
        yield
    finally:
        if not before and "mro" in vars(ecore.Metasubinstance):
            del ecore.Metasubinstance.mro


def _classifier(epackage: Any, name: str) -> Any:
    found = epackage.getEClassifier(name)
    if found is None:
        raise InternalError(f"{name}: missing from the EPackage {epackage.nsURI}")
    return found


def _build(package: Package) -> None:
    """Make shells of the package and of all that it needs, then fill them: packages may refer in circles."""
    pending, shells = [package], []
    while pending:
        current = pending.pop()
        if current.pyecore is not None:
            continue
        if isinstance(current.ecore, ecore.EPackage):
            object.__setattr__(current, "pyecore", _given(current))
        else:
            object.__setattr__(current, "pyecore", _shell(current))
            shells.append(current)
        pending.extend(_needed(current))
    for shell in shells:
        if shell.parent and shell.parent in shell.known:
            epackage_of(shell.known[shell.parent]).eSubpackages.append(shell.pyecore)
        for metaclass in _made_here(shell):
            _fill(metaclass, _classifier(shell.pyecore, metaclass.name), shell)


def _given(package: Package) -> Any:
    """Return the EPackage with the package's nsURI in the one that was handed in."""
    pending: list[Any] = [package.ecore]
    while pending:
        epackage = pending.pop()
        if epackage.nsURI == package.ns_uri:
            return epackage
        pending.extend(epackage.eSubpackages)
    raise InternalError(f"{package.ns_uri}: not in the EPackage it came from")


def _needed(package: Package) -> list[Package]:
    uses = {above.ns_uri for metaclass in package.metaclasses for above in metaclass.supertypes}
    uses |= {feature.type.ns_uri for metaclass in package.metaclasses for feature in metaclass.features}
    uses.add(package.parent)
    return [package.known[ns_uri] for ns_uri in sorted(uses) if ns_uri in package.known]


def _shell(package: Package) -> Any:
    epackage = ecore.EPackage(package.name, nsURI=package.ns_uri, nsPrefix=package.prefix)
    _document(epackage, package.documentation)
    for enumeration in package.enumerations:
        epackage.eClassifiers.append(_enumeration(enumeration))
    for datatype in package.datatypes:
        epackage.eClassifiers.append(ecore.EDataType(datatype.name, eType=datatype.python))
    for metaclass in _made_here(package):
        eclass = ecore.EClass(metaclass.name, abstract=metaclass.abstract)
        _document(eclass, metaclass.documentation)
        epackage.eClassifiers.append(eclass)
    return epackage


def _made_here(package: Package) -> list[Metaclass]:
    """Return the classes of a package that pyecore does not have itself."""
    return [kind for kind in package.metaclasses if kind.ns_uri != ECORE or kind.name in _OWN_ECORE]


def _enumeration(enumeration: Enumeration) -> Any:
    made = ecore.EEnum(enumeration.name)
    _document(made, enumeration.documentation)
    for literal in enumeration.literals:
        made.eLiterals.append(_literal(literal))
    return made


def _literal(literal: Literal) -> Any:
    made = ecore.EEnumLiteral(literal.name, literal.value)
    _document(made, literal.documentation)
    return made


def _fill(metaclass: Metaclass, eclass: Any, package: Package) -> None:
    for above in metaclass.supertypes:
        if above.key != (ECORE, "EObject"):
            eclass.eSuperTypes.append(_type(above, package))
    for feature in metaclass.features:
        if feature.owner is metaclass:
            _declare(eclass, _feature(feature, package))
    for feature in metaclass.features:
        if feature.owner is metaclass and feature.opposite is not None:
            _join(feature, eclass, package)


def _declare(eclass: Any, made: Any) -> None:
    """Add a feature to a class, and to its Python class unless that cannot have an attribute of its name."""
    made_of = eclass.python_class
    made_of._staticEClass = made.name in _KEPT  # then pyecore leaves the Python class as it is
    try:
        eclass.eStructuralFeatures.append(made)
    finally:
        made_of._staticEClass = False


def _join(feature: Feature, eclass: Any, package: Package) -> None:
    """Set both ends as soon as both exist, which is when the second of them is made."""
    assert feature.opposite is not None
    other = _type(feature.opposite.owner, package).findEStructuralFeature(feature.opposite.name)
    if other is not None:
        eclass.findEStructuralFeature(feature.name).eOpposite = other


def _feature(feature: Feature, package: Package) -> Any:
    kind = _type(feature.type, package)
    bounds = {"lower": feature.lower, "upper": feature.most, "unique": feature.unique}
    if feature.is_reference:
        made = ecore.EReference(feature.name, kind, containment=feature.containment, **bounds)
    else:
        made = ecore.EAttribute(feature.name, kind, iD=feature.is_id, **bounds)
        text = _default_text(feature)
        if text is not None:
            made.defaultValueLiteral = text
    made.unsettable = feature.unsettable
    made.transient = not feature.stored
    _document(made, feature.documentation)
    return made


def _default_text(feature: Feature) -> str | None:
    """Return the default in the form that pyecore reads: it looks for names of literals, not for literals."""
    kind = feature.type
    if feature.default is None or isinstance(kind, Metaclass):
        return None
    if isinstance(kind, Enumeration):
        return str(feature.default)
    return None if feature.default == kind.primitive_default else kind.render(feature.default)


def _type(kind: Metaclass | DataType | Enumeration, package: Package) -> Any:
    if kind.ns_uri == ECORE and kind.name not in _OWN_ECORE:
        return _of_ecore(kind)
    if kind.ns_uri in package.known and not (kind.ns_uri == XML_TYPES and isinstance(kind, DataType)):
        return _classifier(package.known[kind.ns_uri].pyecore, kind.name)
    assert isinstance(kind, DataType)  # one of EMF's types of XML, which pyecore has not
    return ecore.EDataType(kind.name, eType=kind.python, default_value=kind.primitive_default)


def _of_ecore(kind: Metaclass | DataType | Enumeration) -> Any:
    """Return what pyecore itself has; of types whose values live in Java only, it has few."""
    if isinstance(kind, Metaclass):
        return getattr(ecore, kind.name).eClass
    return ecore.getEClassifier(kind.name) or ecore.EJavaObject


def _document(element: Any, text: str) -> None:
    if text:
        annotation = ecore.EAnnotation(source=GENMODEL)
        annotation.details["documentation"] = text
        element.eAnnotations.append(annotation)
