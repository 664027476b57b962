"""Diagnostic codes of reading, metamodels, projects, coordinates and logs; constraints have their own."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.errors import UnreadableError


@dataclass(frozen=True, slots=True)
class Advice:
    """What all diagnostics of one code have in common.

    Attributes:
        meaning: the title: what is wrong.
        expected: what is required instead.
        hint: how to fix it, unless the diagnostic has a better hint.
        brief: whether diagnostics omit both, because there may be many.
    """

    meaning: str
    expected: str
    hint: str
    severity: Severity = Severity.ERROR
    brief: bool = False


CODES: Mapping[str, Advice] = MappingProxyType(
    {
        "XMI001": Advice(
            "Language not installed",
            "an element of an installed language",
            "install the plug-in that provides the language, or correct the nsURI; 'mmrs metamodel "
            "list' lists installed languages",
        ),
        "XMI002": Advice(
            "Unknown class",
            "the name of a class of the language",
            "correct the name; 'mmrs metamodel list' lists installed languages",
        ),
        "XMI003": Advice(
            "Abstract class; xsi:type is missing",
            "a concrete subclass of the class",
            'state the class by xsi:type="prefix:Class", in JSON by "$type": "prefix:Class"',
        ),
        "XMI004": Advice(
            "Unknown attribute or child element",
            "only attributes and child elements of the element's class",
            "correct the name or remove it; docs/languages.md lists the features of each class",
        ),
        "XMI005": Advice(
            "Invalid attribute value",
            "a value of the attribute's type: a number, an enum literal, true or false",
            "correct the value, or omit the attribute if it is optional",
        ),
        "XMI006": Advice(
            "Unresolved reference",
            "a reference to an element: its name, //@tasks.0 or #id",
            "correct the name, or the path, which counts from 0 in file order",
        ),
        "XMI007": Advice(
            "Reference to a file outside the project",
            "a reference to a model inside the project folder",
            "move the other file into the project, and refer to it by its relative path",
        ),
        "XMI008": Advice(
            "Element of a class that is not allowed here",
            "an element of the class that the message names",
            "choose a class that fits, or refer to another element",
        ),
        "XMI009": Advice("Too many values", "one value", "keep one value and remove the others"),
        "XMI010": Advice(
            "Text where elements are expected, or the reverse",
            "elements inside elements, and text inside values",
            "remove the text, make it a comment, or put it into an attribute",
        ),
        "XMI011": Advice(
            "Extension of another tool, which is not read",
            "only the model's own elements",
            "remove it if it is not needed: saving the model loses it",
            Severity.WARNING,
        ),
        "XMI012": Advice(
            "Duplicate xmi:id",
            "an id that no other element has",
            "give one of the elements another id, and correct the references to it",
        ),
        "XMI013": Advice(
            "The two ends of a reference contradict each other",
            "two ends that refer to each other",
            "correct one end, or omit it: it follows from the other",
        ),
        "XMI014": Advice(
            "Undeclared namespace prefix",
            "a prefix that is declared at the root",
            'declare it as xmlns:prefix="nsURI", or among $languages in JSON',
        ),
        "XMI015": Advice(
            "Root element without a namespace",
            "a root whose language is stated",
            'write the root as prefix:Class, and declare xmlns:prefix="nsURI"; in JSON, give it a $type',
        ),
        "XMI016": Advice(
            "Reference to a file that cannot be read",
            "a reference to a readable model",
            "correct the path, or add the file",
        ),
        "XMI017": Advice(
            "Element of another file that cannot be contained here",
            "an element that no other element contains",
            "contain it once, and refer to it elsewhere",
        ),
        "XMI018": Advice(
            "Name of several elements",
            "a name that is unique where the reference stands",
            "rename one of them, or write the path, such as //@tasks.0",
        ),
        "ECO001": Advice(
            "Missing required value", "a value for every required feature", "add the value: it has no default"
        ),
        "ECO002": Advice(
            "Too few or too many values",
            "as many values as the message states",
            "add the missing values, or remove the surplus",
        ),
        "ECO003": Advice(
            "Value of the wrong type", "a value of the type that the message names", "correct the value"
        ),
        "ECO004": Advice(
            "Invalid enum literal",
            "one of the literals that the message lists",
            "choose one of the listed literals",
        ),
        "ECO005": Advice(
            "Element of the wrong class",
            "an element of the class that the message names",
            "replace it by an element of that class, or move it to where it belongs",
        ),
        "ECO006": Advice("Duplicate value among unique values", "each value once", "remove the duplicate"),
        "ECO007": Advice(
            "Inconsistent containment", "an element that exactly one container contains", "contain it once"
        ),
        "ECO008": Advice(
            "Reference to an uncontained element",
            "a reference to an element of a model",
            "put it into a containment feature of the model",
        ),
        "ECO009": Advice(
            "Number that is not finite",
            "a finite number",
            "state a number, or omit the attribute if the value is unknown",
        ),
        "ECO010": Advice(
            "Element of a language that is not installed",
            "an element of an installed language",
            "install the plug-in that provides the language",
        ),
        "ECO011": Advice(
            "Opposite reference does not refer back",
            "two ends that refer to each other",
            "set one end; the other follows",
        ),
        "ECO012": Advice(
            "Duplicate identifier",
            "an identifier that no other element has",
            "give one of the elements another identifier",
        ),
        "ECO013": Advice(
            "Duplicate key",
            "one element for each key: in a map, and wherever the metamodel has eKeys",
            "give one of the elements another key, or remove it: references would resolve to the wrong one",
        ),
        "ECO014": Advice(
            "Value that Eclipse may read differently",
            "an unambiguous value, such as the date 2024-05-01T10:11:12.123+0200",
            "write it in the format that EMF writes",
            Severity.WARNING,
        ),
        "FIL001": Advice("File not found", "an existing file", "correct the path"),
        "FIL002": Advice(
            "File not readable",
            "a file that the current user may read",
            "grant read permission, or name another file",
        ),
        "FIL003": Advice(
            "File too large",
            "a model within the reader's limits",
            "split the model into several files, or name the right file",
        ),
        "FIL004": Advice(
            "Malformed XML",
            "well-formed XML: every tag is closed",
            "correct this line or the previous one; copy a truncated file again",
        ),
        "FIL005": Advice(
            "DOCTYPE is not allowed",
            "a model without DOCTYPE",
            "remove the DOCTYPE: it could make a model read other files",
        ),
        "FIL006": Advice(
            "Reader limit exceeded", "a model within the reader's limits", "check that the file is a model"
        ),
        "FIL007": Advice(
            "Malformed JSON",
            "JSON in UTF-8, without duplicate keys in an object",
            "correct this line or the previous one; copy a truncated file again",
        ),
        "FIL008": Advice(
            "Too many problems",
            "a model of the installed languages",
            "fix the first problem: most others follow from it",
        ),
        "FIL009": Advice(
            "File of another tool without a model",
            "a file with a mission, context, robot type or behaviour",
            "name the file that contains the model",
        ),
        "FIL010": Advice(
            "Model of another tool that cannot be imported",
            "an importer whose languages are installed",
            "install the plug-ins that the importer needs, or omit --no-plugins",
        ),
        "MIG001": Advice(
            "Model of an older language version",
            "a model of the installed version",
            "save the model to upgrade it, for example with 'mmrs convert'; the file is unchanged",
            Severity.NOTE,
        ),
        "MIG002": Advice(
            "Value without a place in the newer language version",
            "only values that the newer version has",
            "check whether the value is needed; if so, express it in another way",
            Severity.WARNING,
        ),
        "MIG003": Advice(
            "Imported model of another tool",
            "a model of the installed languages",
            "the file is unchanged; 'mmrs migrate' makes a project of it",
            Severity.NOTE,
            brief=True,
        ),
        "MIG004": Advice(
            "Unknown nsURI, taken for another tool's by its class names",
            "the nsURI of the tool's language",
            "if the model is of that tool, correct the nsURI; otherwise give its metamodel with --metamodel",
            Severity.WARNING,
        ),
        "MIG005": Advice(
            "Values defaulted or changed on import",
            "values with the same meaning here, and all required values",
            "check them; --quiet-migration does not list them",
            Severity.NOTE,
            brief=True,
        ),
        "MIG006": Advice(
            "Values doubtful or not carried over on import",
            "values that have one meaning and a place here",
            "check that the mission still means the same; if not, 'mmrs migrate' it and correct the result",
            Severity.WARNING,
            brief=True,
        ),
        "MIG007": Advice(
            "Root element that is not imported",
            "a mission, context, robot type or behaviour",
            "name the file that contains the model, or remove the element",
        ),
        "GND001": Advice(
            "Coordinate without a known position",
            "a coordinate whose origin and reference are known",
            "correct the coordinate or its reference",
        ),
        "GND002": Advice(
            "Robot type lacks data for planning",
            "a robot type with all data for planning, such as size and speed",
            "add it to the robot type's file",
        ),
        "GND003": Advice(
            "Unknown robot type",
            "the name of a robot type of the project",
            "add the robot type to the project's robots folder, or correct the name",
        ),
        "GND004": Advice(
            "Element of a plug-in that is not installed",
            "elements of installed languages only",
            "install the plug-in that provides the language, or remove the element",
        ),
        "LOG001": Advice(
            "Log line that is not a step",
            "one step per line, with all fields that the message names",
            "remove the line, or run the mission again for a complete log",
        ),
        "PRJ001": Advice(
            "Duplicate robot type name", "robot types with different names", "give each type its own name"
        ),
        "PRJ003": Advice(
            "Ambiguous project files",
            "one mission.xmi or mission.json, and next to it at most one context in the same format",
            "name the mission file, or rename the files of the project",
        ),
        "PRJ002": Advice(
            "Unexpected content in a project file",
            "one mission in mission.xmi, one context in context.xmi, robot types in robots",
            "name the mission file or its folder, or move the unexpected content to a file of its own",
        ),
    }
)


def refusal(error: UnreadableError) -> tuple[Diagnostic, ...]:
    """Return the diagnostics of an unreadable file; empty if it is not a model file."""
    if error.diagnostics or not error.code:
        return error.diagnostics
    place = Place(error.file, error.line)
    return (explained(Diagnostic(error.code, Severity.ERROR, error.reason, place)),)


def is_refusal(fault: Diagnostic) -> bool:
    """Return whether a diagnostic says that a whole file cannot be read."""
    return fault.code.startswith("FIL") or fault.code == "PRJ003"


def explained(fault: Diagnostic) -> Diagnostic:
    """Return a diagnostic with the expectation of its code, and with the code's hint if it has none."""
    code = CODES.get(fault.code)
    if code is None or code.brief:
        return fault
    return replace(fault, expected=fault.expected or code.expected, hint=fault.hint or code.hint)
