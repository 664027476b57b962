"""Ecore and EMF's types of XML as metamodels of their own, for models and metamodels that refer to them.

They hold what files can hold, and the references back to containers. What Java works out, such as
``EClass.eAllSuperTypes``, is left out, and so are feature maps. The facts are those of
``Ecore.ecore`` and ``XMLType.ecore`` in EMF 2.29.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from typing import Any

from pyecore import ecore

from mmrs_core.languages.datatypes import ECORE, ECORE_CLASSES, XML_CLASSES, XML_TYPES, builtin_type
from mmrs_core.languages.metaclass import MAP_ENTRY

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


@cache
def built_in() -> tuple[ecore.EPackage, ecore.EPackage]:
    """Return Ecore and EMF's types of XML; always the same objects.

    pyecore's own classes of Ecore have less than EMF's: they are what metamodels refer to, and these are what
    models of Ecore hold.
    """
    types = {**dict.fromkeys(ECORE_CLASSES, ""), **_NOT_IN_FILES}
    texts = dict.fromkeys((*XML_CLASSES, *_XML_TEXTS.split()), "")
    return (_package("ecore", ECORE, _ECORE, types), _package("type", XML_TYPES, _XML, texts))


def _package(name: str, ns_uri: str, text: str, types: Mapping[str, str]) -> ecore.EPackage:
    """Return the package of a table: a line for each class with its supertypes, one for each feature."""
    prefix = name if ns_uri == ECORE else "ecore.xml.type"
    package = ecore.EPackage(name, nsURI=ns_uri, nsPrefix=prefix)
    for each, java in types.items():
        known = builtin_type(ns_uri, each)
        if known is None:
            kind = ecore.EDataType(each, eType=object)
        else:
            kind = ecore.EDataType(each, eType=known.python, default_value=known.primitive_default)
        kind.instanceClassName_ = java or None
        kind.serializable = not java
        package.eClassifiers.append(kind)
    blocks = [block.split("\r") for block in text.strip().replace("\n  ", "\r").split("\n")]
    for head, *_ in blocks:
        words = head.removeprefix("abstract ").split()
        package.eClassifiers.append(ecore.EClass(words[0], abstract=head.startswith("abstract ")))
    kinds: dict[str, Any] = {kind.name: kind for kind in package.eClassifiers}
    for head, *rows in blocks:
        words = head.removeprefix("abstract ").split()
        eclass = kinds[words[0]]
        eclass.eSuperTypes.extend(kinds[above] for above in words[1:])
        if words[0].endswith("MapEntry"):
            eclass.instanceClassName = MAP_ENTRY
        for row in rows:
            eclass.eStructuralFeatures.append(_feature(row.split(), kinds))
    for head, *rows in blocks:
        eclass = kinds[head.removeprefix("abstract ").split()[0]]
        for row in rows:
            for mark in row.split():
                if mark.startswith("~"):
                    owner, _, other = mark[1:].partition("/")
                    feature = eclass.findEStructuralFeature(row.split()[0])
                    feature.eOpposite = kinds[owner].findEStructuralFeature(other)
    return package


def _feature(words: list[str], kinds: Mapping[str, Any]) -> ecore.EStructuralFeature:
    name, *rest = words
    link = rest.pop(0) if rest[0] in (">", "-") else ""
    kind, *marks = rest
    bounds = {"lower": 1 if "1" in marks else 0, "upper": -1 if "*" in marks else 1}
    if link:
        made = ecore.EReference(name, kinds[kind], containment=link == ">", **bounds)
    else:
        default = next((mark[1:] for mark in marks if mark.startswith("=")), None)
        made = ecore.EAttribute(name, kinds.get(kind) or ecore.EString, defaultValueLiteral=default, **bounds)
    made.unsettable = "unset" in marks
    made.transient = "transient" in marks
    return made
