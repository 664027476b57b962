"""Ecore and EMF's types of XML as metamodels of their own, for models and metamodels that refer to them.

They hold what files can hold, and the ways back to containers. What Java works out, such as
``EClass.eAllSuperTypes``, is left out, and so are feature maps. The facts are those of
``Ecore.ecore`` and ``XMLType.ecore`` in EMF 2.29.
"""

from __future__ import annotations

from collections.abc import Iterator

from mmrs_core.languages.datatypes import ECORE, XML_TYPES
from mmrs_core.languages.metamodels.locating import Located
from mmrs_core.languages.metamodels.tables import (
    MAP_ENTRY,
    ClassTable,
    DataTypeTable,
    FeatureTable,
    PackageTable,
)
from mmrs_core.languages.values.java_classes import ECORE_CLASSES, XML_CLASSES

BUILT_IN = (ECORE, XML_TYPES)
"""The nsURIs of metamodels that nobody brings."""

_ECORE = """
EObject
abstract EModelElement
  eAnnotations > EAnnotation * ~EAnnotation/eModelElement
EAnnotation EModelElement
  source EString
  eModelElement - EModelElement transient ~EModelElement/eAnnotations
  details > EStringToStringMapEntry *
  contents > EObject *
  references - EObject *
abstract ENamedElement EModelElement
  name EString
EStringToStringMapEntry
  key EString
  value EString
EPackage ENamedElement
  nsURI EString
  nsPrefix EString
  eClassifiers > EClassifier * ~EClassifier/ePackage
  eSubpackages > EPackage * ~EPackage/eSuperPackage
  eSuperPackage - EPackage transient ~EPackage/eSubpackages
EFactory EModelElement
abstract EClassifier ENamedElement
  instanceClassName EString unset
  instanceTypeName EString unset
  ePackage - EPackage transient ~EPackage/eClassifiers
  eTypeParameters > ETypeParameter *
EClass EClassifier
  abstract EBoolean
  interface EBoolean
  eSuperTypes - EClass * unset
  eOperations > EOperation * ~EOperation/eContainingClass
  eStructuralFeatures > EStructuralFeature * ~EStructuralFeature/eContainingClass
  eGenericSuperTypes > EGenericType * unset
EDataType EClassifier
  serializable EBoolean =true
EEnum EDataType
  eLiterals > EEnumLiteral * ~EEnumLiteral/eEnum
EEnumLiteral ENamedElement
  value EInt =0
  literal EString
  eEnum - EEnum transient ~EEnum/eLiterals
ETypeParameter ENamedElement
  eBounds > EGenericType *
EGenericType
  eUpperBound > EGenericType
  eTypeArguments > EGenericType *
  eLowerBound > EGenericType
  eTypeParameter - ETypeParameter
  eClassifier - EClassifier
abstract ETypedElement ENamedElement
  ordered EBoolean =true
  unique EBoolean =true
  lowerBound EInt =0
  upperBound EInt =1
  eType - EClassifier unset
  eGenericType > EGenericType unset
EParameter ETypedElement
  eOperation - EOperation transient ~EOperation/eParameters
EOperation ETypedElement
  eContainingClass - EClass transient ~EClass/eOperations
  eTypeParameters > ETypeParameter *
  eParameters > EParameter * ~EParameter/eOperation
  eExceptions - EClassifier * unset
  eGenericExceptions > EGenericType * unset
abstract EStructuralFeature ETypedElement
  changeable EBoolean =true
  volatile EBoolean
  transient EBoolean
  defaultValueLiteral EString
  unsettable EBoolean
  derived EBoolean
  eContainingClass - EClass transient ~EClass/eStructuralFeatures
EAttribute EStructuralFeature
  iD EBoolean
EReference EStructuralFeature
  containment EBoolean
  resolveProxies EBoolean =true
  eOpposite - EReference
  eKeys - EAttribute *
"""

_XML = """
AnyType
ProcessingInstruction
  data String
  target String 1
SimpleAnyType AnyType
"""

_XML_TEXTS = """
AnySimpleType AnyURI Date DateTime Duration ENTITIES ENTITIESBase ENTITY GDay GMonth GMonthDay GYear
GYearMonth ID IDREF IDREFS IDREFSBase Language NCName NMTOKEN NMTOKENS NMTOKENSBase NOTATION Name
NormalizedString QName String Time Token
"""
"""EMF's types of XML beside those whose Java classes are known."""
_NOT_IN_FILES = {
    "EDiagnosticChain": "org.eclipse.emf.common.util.DiagnosticChain",
    "EEList": "org.eclipse.emf.common.util.EList",
    "EFeatureMap": "org.eclipse.emf.ecore.util.FeatureMap",
    "EEnumerator": "org.eclipse.emf.common.util.Enumerator",
    "EInvocationTargetException": "java.lang.reflect.InvocationTargetException",
    "EMap": "java.util.Map",
    "EResource": "org.eclipse.emf.ecore.resource.Resource",
    "EResourceSet": "org.eclipse.emf.ecore.resource.ResourceSet",
    "ETreeIterator": "org.eclipse.emf.common.util.TreeIterator",
}
"""Types of Ecore whose values live in Java only, with their Java classes."""


def built_in() -> tuple[Located, ...]:
    """Return Ecore and EMF's types of XML."""
    known = tuple(map(DataTypeTable, ECORE_CLASSES))
    types = (*known, *(DataTypeTable(name, java, False) for name, java in _NOT_IN_FILES.items()))
    ecore = PackageTable(ECORE, "ecore", "ecore", "", tuple(_classes(_ECORE, ECORE)), (), types)
    xml_types = tuple(map(DataTypeTable, (*XML_CLASSES, *_XML_TEXTS.split())))
    xml = PackageTable(
        XML_TYPES, "type", "ecore.xml.type", "", tuple(_classes(_XML, XML_TYPES)), (), xml_types
    )
    return Located(ecore, "core", None, None), Located(xml, "core", None, None)


def _classes(text: str, ns_uri: str) -> Iterator[ClassTable]:
    """Yield the classes of a table: a line for each with its supertypes, an indented one for each feature."""
    blocks = text.strip().replace("\n  ", "\r").split("\n")
    for head, *rows in (block.split("\r") for block in blocks):
        words = head.removeprefix("abstract ").split()
        yield ClassTable(
            words[0],
            head.startswith("abstract "),
            supertypes=tuple(f"{ns_uri}#//{name}" for name in words[1:]),
            features=tuple(_feature(row.split(), ns_uri) for row in rows),
            java_class=MAP_ENTRY if words[0].endswith("MapEntry") else "",
        )


def _feature(words: list[str], ns_uri: str) -> FeatureTable:
    name, *rest = words
    link = rest.pop(0) if rest[0] in (">", "-") else ""
    kind, *marks = rest
    return FeatureTable(
        name,
        f"{ns_uri}#//{kind}",
        is_reference=bool(link),
        lower=1 if "1" in marks else 0,
        upper=-1 if "*" in marks else 1,
        containment=link == ">",
        unsettable="unset" in marks,
        stored="transient" not in marks,
        opposite=next((f"{ns_uri}#//{mark[1:]}" for mark in marks if mark.startswith("~")), ""),
        default=next((mark[1:] for mark in marks if mark.startswith("=")), None),
    )
