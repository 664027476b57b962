"""Edits of the zoo's metamodel, each with whether models of the zoo as it was still load."""

import re
from pathlib import Path

ZOO = Path(__file__).parents[1] / "fixtures" / "models" / "zoo.ecore"
ECORE = "ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//"


def _attribute(name: str, kind: str, more: str = "") -> str:
    tail = f" {more}" if more else ""
    return f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="{name}" eType="{ECORE}{kind}"{tail}/>'


TEETH = _attribute("teeth", "EInt", 'defaultValueLiteral="30"')
WEIGHT = _attribute("weight", "EDouble")
STEPS = _attribute("steps", "ELong")
BORN = _attribute("born", "EDate")
CAGE = _attribute("cage", "EByte")
MOTTO = _attribute("motto", "EString", 'defaultValueLiteral="roar"')
EGGS = _attribute("eggs", "EInt")
NEST = (
    '<eStructuralFeatures xsi:type="ecore:EReference" name="nest" eType="#//wing/Nest" containment="true"/>'
)
DEPUTY = '<eStructuralFeatures xsi:type="ecore:EReference" name="deputy" eType="#//Keeper"/>'
DEPUTY_OF = DEPUTY.replace("deputy", "deputyOf").replace("/>", ' eOpposite="#//Keeper/deputy"/>')
PAIRED = DEPUTY.replace("/>", ' eOpposite="#//Keeper/deputyOf"/>')
MATES = (
    ' eOpposite="#//Animal/mateOf"/>\n    <eStructuralFeatures xsi:type="ecore:EReference" name="mateOf"'
    ' eType="#//Animal" eOpposite="#//Animal/mate"/>'
)
CALM = '<eLiterals name="CALM" value="5" literal="is-calm"/>'
ANGRY = '<eLiterals name="ANGRY" value="2"/>'

EDITS: dict[str, tuple[str, str, str]] = {
    "an optional feature is added": (TEETH, TEETH + _attribute("claws", "EInt"), "compatible"),
    "a required feature is added": (
        TEETH,
        TEETH + _attribute("id", "EString", 'lowerBound="1"'),
        "incompatible",
    ),
    "a required number has a default": (
        TEETH,
        TEETH + _attribute("n", "EInt", 'lowerBound="1"'),
        "compatible",
    ),
    "a feature is removed": (WEIGHT, "", "incompatible"),
    "a feature is renamed": (WEIGHT, _attribute("mass", "EDouble"), "incompatible"),
    "a transient feature is removed": (_attribute("guess", "EInt", 'transient="true"'), "", "compatible"),
    "a whole number takes more bits": (TEETH, TEETH.replace("EInt", "ELong"), "compatible"),
    "a whole number takes fewer bits": (STEPS, STEPS.replace("ELong", "EInt"), "incompatible"),
    "a whole number becomes a real one": (STEPS, STEPS.replace("ELong", "EDouble"), "compatible"),
    "a real number becomes a whole one": (WEIGHT, WEIGHT.replace("EDouble", "EInt"), "incompatible"),
    "a date becomes a text": (BORN, BORN.replace("EDate", "EString"), "compatible"),
    "a byte may be absent": (CAGE, CAGE.replace("EByte", "EByteObject"), "changed meaning"),
    "a default changes": (TEETH, TEETH.replace("30", "28"), "changed meaning"),
    "a text becomes required": (MOTTO, MOTTO.replace("eType", 'lowerBound="1" eType'), "compatible"),
    "a text becomes many": (MOTTO, MOTTO.replace("eType", 'upperBound="-1" eType'), "incompatible"),
    "a number becomes many": (WEIGHT, WEIGHT.replace("eType", 'upperBound="-1" eType'), "compatible"),
    "a number becomes required": (WEIGHT, WEIGHT.replace("eType", 'lowerBound="1" eType'), "compatible"),
    "many become one": ('name="weights" upperBound="3"', 'name="weights"', "incompatible"),
    "many become fewer": ('name="weights" upperBound="3"', 'name="weights" upperBound="2"', "incompatible"),
    "many become more": ('name="weights" upperBound="3"', 'name="weights" upperBound="-1"', "compatible"),
    "values must differ": (
        'eType="' + ECORE + 'EDouble" unique="false"',
        f'eType="{ECORE}EDouble"',
        "incompatible",
    ),
    "elements must differ by a key": (
        'name="keepers" upperBound="-1"',
        'name="keepers" upperBound="-1" eKeys="#//Keeper/badge"',
        "incompatible",
    ),
    "a class becomes abstract": ('name="Otter"', 'name="Otter" abstract="true"', "incompatible"),
    "a class is not abstract any more": ('name="Swimmer" abstract="true"', 'name="Swimmer"', "compatible"),
    "a class has a supertype less": ("#//Animal #//Swimmer", "#//Animal", "incompatible"),
    "a class has a supertype more": ('name="Keeper"', 'name="Keeper" eSuperTypes="#//Swimmer"', "compatible"),
    "a literal is added": (ANGRY, ANGRY + '<eLiterals name="MAD" value="7"/>', "compatible"),
    "a literal is removed": (ANGRY, "", "incompatible"),
    "a literal has another number": (ANGRY, ANGRY.replace('"2"', '"22"'), "compatible"),
    "a literal is spelt another way": (CALM, CALM.replace("is-calm", "calm"), "incompatible"),
    "an inner package has a feature less": (EGGS, "", "incompatible"),
    "a part becomes a mere reference": (NEST, NEST.replace(' containment="true"', ""), "incompatible"),
    "a reference becomes a part": (DEPUTY, DEPUTY.replace("/>", ' containment="true"/>'), "incompatible"),
    "a reference may lead to anything": (
        DEPUTY,
        DEPUTY.replace("#//Keeper", "ecore:EClass http://www.eclipse.org/emf/2002/Ecore#//EObject"),
        "compatible",
    ),
    "a reference gets another end": (DEPUTY, PAIRED + DEPUTY_OF, "incompatible"),
    "a reference gets another end that takes many": (
        DEPUTY,
        PAIRED + DEPUTY_OF.replace("eType", 'upperBound="-1" eType'),
        "compatible",
    ),
    "a reference loses its other end": (MATES, re.sub(' eOpposite="[^"]*"', "", MATES), "changed meaning"),
    "a type of its own is another in Java": ("java.net.URI", "java.lang.Integer", "incompatible"),
    "a type of its own becomes an enumeration": (
        '"ecore:EDataType" name="Colour" instanceClassName="java.net.URI"',
        '"ecore:EEnum" name="Colour"',
        "incompatible",
    ),
    "an id is an id no longer": (' iD="true"', "", "incompatible"),
    "a number becomes an id": (STEPS, STEPS.replace("/>", ' iD="true"/>'), "incompatible"),
}
"""What is replaced by what, and what becomes of old models, by a name."""


def edited(*names: str) -> str:
    """Return the zoo's metamodel after some of the edits; each part of it is edited once."""
    text = ZOO.read_text(encoding="utf-8")
    for name in names:
        before, after, _ = EDITS[name]
        text = text.replace(before, after, 1)
    return text
