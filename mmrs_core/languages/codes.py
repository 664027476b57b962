"""The codes of faults that are no constraint's: of reading, of metamodels, of projects, places and logs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType

from mmrs_core.diagnostics import Diagnostic, Place, Severity
from mmrs_core.errors import UnreadableError


@dataclass(frozen=True, slots=True)
class Code:
    """What all faults of one code have in common.

    Attributes:
        meaning: what is wrong.
        expected: what there ought to be instead.
        hint: how to mend it, where the fault itself knows nothing better.
        brief: whether its faults, of which there may be long lists, are told without that.
    """

    meaning: str
    expected: str
    hint: str
    severity: Severity = Severity.ERROR
    brief: bool = False


CODES: Mapping[str, Code] = MappingProxyType(
    {
        "XMI001": Code(
            "an element of a language that is not installed",
            "an element of an installed language",
            "install the plug-in that brings the language, or correct its address (nsURI); "
            "'mmrs metamodel list' shows what is installed",
        ),
        "XMI002": Code(
            "a class that its language does not have",
            "the name of a class of that language",
            "correct the name; 'mmrs metamodel list' shows the languages that are installed",
        ),
        "XMI003": Code(
            "an element that does not say which kind of its class it is",
            "one of the kinds of that class",
            'state the kind by xsi:type="prefix:Class", in JSON by "$type": "prefix:Class"',
        ),
        "XMI004": Code(
            "an element has something that its class does not know",
            "only attributes and parts that the element's class has",
            "correct the name, or take it away; the page about languages lists what each class has",
        ),
        "XMI005": Code(
            "a value that the attribute does not take",
            "a value that the attribute takes: a number, a word of its list, true or false",
            "correct the value, or leave the attribute out where it is optional",
        ),
        "XMI006": Code(
            "a reference that leads to no element",
            "a reference to an element, as //@tasks.0 or #id",
            "count from 0 in the order of the file, or correct the id",
        ),
        "XMI007": Code(
            "a reference to a file that may not be opened",
            "a reference to a model inside the project's folder",
            "move the other file into the project, and refer to it by its relative path",
        ),
        "XMI008": Code(
            "an element of a class that does not belong there",
            "an element of the class that the message names",
            "choose a class that fits, or refer to another element",
        ),
        "XMI009": Code(
            "several values where one is allowed", "one value", "keep one of them, and take the others away"
        ),
        "XMI010": Code(
            "text where only elements may stand, or the reverse",
            "elements inside elements, and text inside values",
            "take the text away, make it a comment, or put it into an attribute",
        ),
        "XMI011": Code(
            "a note of another tool inside the model, which is not read",
            "only the model's own elements",
            "take it away if nobody needs it: saving the model loses it",
            Severity.WARNING,
        ),
        "XMI012": Code(
            "an id that two elements of a file have",
            "an id that no other element has",
            "give one of them another id, and correct what refers to it",
        ),
        "XMI013": Code(
            "the two ends of a reference contradict each other",
            "two ends that refer to each other",
            "correct one end, or leave it out: it follows from the other",
        ),
        "XMI014": Code(
            "a namespace prefix that is not declared",
            "a prefix that is declared at the root",
            'declare it as xmlns:prefix="nsURI", or among $languages in JSON',
        ),
        "XMI015": Code(
            "a root element without a namespace",
            "a root that says which language it is of",
            'write the root as prefix:Class, and declare xmlns:prefix="nsURI"; in JSON, give it a $type',
        ),
        "XMI016": Code(
            "a reference to a file that cannot be read",
            "a reference to a model that can be read",
            "correct the path, or put the file there",
        ),
        "XMI017": Code(
            "an element of another file that cannot be contained here",
            "an element that no other element contains",
            "contain it once, and refer to it elsewhere",
        ),
        "ECO001": Code(
            "a required value is missing",
            "a value for everything that has to be known",
            "write it, since there is no default",
        ),
        "ECO002": Code(
            "too few or too many values",
            "as many values as the message says",
            "add what is missing, or take away what is too much",
        ),
        "ECO003": Code(
            "a value of another kind than the attribute takes",
            "a value of the kind that the message names",
            "correct the value",
        ),
        "ECO004": Code(
            "a word that is not among those that the attribute takes",
            "one of the words that the message lists",
            "choose one of those that the message lists",
        ),
        "ECO005": Code(
            "an element of the wrong class",
            "an element of the class that the message names",
            "put an element of that class there, or move this one to where it belongs",
        ),
        "ECO006": Code(
            "the same value twice among values that must differ",
            "each value once",
            "take the repetition away",
        ),
        "ECO007": Code(
            "an element that its container does not know, or that two contain",
            "an element that one container holds",
            "contain it once",
        ),
        "ECO008": Code(
            "a reference to an element that stands in no model",
            "a reference to an element of a model",
            "put it into a containment feature of the model",
        ),
        "ECO009": Code(
            "a number that is not finite",
            "a finite number",
            "give a number; leave the attribute out where the value is not known",
        ),
        "ECO010": Code(
            "an element of a language that is not installed",
            "an element of an installed language",
            "install the plug-in that brings the language",
        ),
        "ECO011": Code(
            "a reference whose other end does not refer back",
            "two ends that refer to each other",
            "set one end; the other follows",
        ),
        "ECO012": Code(
            "an identifier that two elements of a model have",
            "an identifier that no other element has",
            "give one of them another",
        ),
        "ECO013": Code(
            "two elements of one key among those that their keys tell apart",
            "one element for each key: in a map, and wherever the metamodel names eKeys",
            "give one of them another key, or take it away: references would lead to the wrong one",
        ),
        "ECO014": Code(
            "a value that Eclipse may understand otherwise than its text suggests",
            "a value that means the same to everybody, such as the date 2024-05-01T10:11:12.123+0200",
            "write it in the form that EMF itself writes",
            Severity.WARNING,
        ),
        "FIL001": Code(
            "a file that is not there",
            "a file of that name",
            "correct the path, or put the file there",
        ),
        "FIL002": Code(
            "a file that the system does not give",
            "a file that whoever runs this may read",
            "permit its reading, or name another file",
        ),
        "FIL003": Code(
            "a file larger than any model",
            "a model within the bounds of what is read",
            "divide the model into several files, or name the right file",
        ),
        "FIL004": Code(
            "text that is not well-formed XML",
            "XML in which every tag is closed by its own",
            "mend the line, or the one in front of it; a file cut short has to be copied anew",
        ),
        "FIL005": Code(
            "a DOCTYPE, which could make a model read other files",
            "a model without DOCTYPE",
            "take the DOCTYPE away: models need none",
        ),
        "FIL006": Code(
            "more in one place than any model has",
            "a model within the bounds of what is read",
            "look whether the file is a model at all",
        ),
        "FIL007": Code(
            "text that is not well-formed JSON",
            "JSON in UTF-8, each key once in its object",
            "mend the line, or the one in front of it; a file cut short has to be copied anew",
        ),
        "FIL008": Code(
            "more faults than anybody would read",
            "a model of the languages that are installed",
            "mend what the first fault is about: most others follow from it",
        ),
        "FIL009": Code(
            "a file of another tool that holds no model",
            "a file with a mission, context, robot type or behaviour",
            "name the file that holds the model",
        ),
        "FIL010": Code(
            "a model of another tool, and what migrates it does not work",
            "a mapping whose languages are installed",
            "install the plug-ins that the mapping names, or leave out --no-plugins",
        ),
        "MIG001": Code(
            "a model of an older version of its language, migrated while it was read",
            "a model of the installed version",
            "save the model to have it in the new version, as 'mmrs convert' does; the file is as it was",
            Severity.NOTE,
        ),
        "MIG002": Code(
            "a value that the newer version of a language has no place for",
            "only what the newer version knows",
            "see whether the value is needed; if so, say it in another way",
            Severity.WARNING,
        ),
        "MIG003": Code(
            "a model of another tool, migrated while it was read",
            "a model in the languages that are installed",
            "the file is as it was; 'mmrs migrate' makes a project of it",
            Severity.NOTE,
            brief=True,
        ),
        "MIG004": Code(
            "a model whose nsURI nobody knows, taken for one of another tool by the names of its classes",
            "the nsURI that the tool gives its language",
            "if it is of that tool, correct the nsURI; else read it by its own .ecore file: --metamodel",
            Severity.WARNING,
        ),
        "MIG005": Code(
            "values that were defaulted or changed in meaning in a model of another tool",
            "values that mean the same here, and all that is needed",
            "see whether that is right; --quiet-migration does not list them",
            Severity.NOTE,
            brief=True,
        ),
        "MIG006": Code(
            "values of a model of another tool that are doubtful here, or not carried over",
            "values that have one meaning, and a place here",
            "see whether the mission still means what it did; if not, 'mmrs migrate' it, and mend the result",
            Severity.WARNING,
            brief=True,
        ),
        "MIG007": Code(
            "a root of another tool's model that nothing comes of",
            "a mission, context, robot type or behaviour",
            "name the file that holds the model, or take the element away",
        ),
        "GND001": Code(
            "a coordinate that has no place",
            "a coordinate whose origin and reference are known",
            "correct the coordinate or what it counts from",
        ),
        "GND002": Code(
            "something that a robot type needs for planning is missing",
            "a robot type with all that planning needs, such as its size and speed",
            "write it into the robot type's file",
        ),
        "GND003": Code(
            "a robot of a type that is not among the models",
            "the name of a robot type of the project",
            "add the robot type to the project's robots folder, or correct the name",
        ),
        "GND004": Code(
            "an element whose plug-in is not installed, where it is needed",
            "elements of installed languages only",
            "install the plug-in that brings the language, or take the element away",
        ),
        "LOG001": Code(
            "a line of a log that is no step",
            "one step a line, with all that the message names",
            "take the line away, or run the mission again to have a whole log",
        ),
        "PRJ001": Code(
            "two types of robot of one name",
            "robot types with different names",
            "give each type its own name",
        ),
        "PRJ003": Code(
            "a project of which it cannot be told which files are meant",
            "one mission.xmi or mission.json, and beside it at most one context of that form",
            "name the mission's file, or give the files of the project these names",
        ),
        "PRJ002": Code(
            "a file of a project that does not hold what belongs there",
            "one mission in mission.xmi, one context in context.xmi, robot types in robots",
            "name the mission's file or its folder, or move what does not belong there to a file of its own",
        ),
    }
)


def refusal(error: UnreadableError) -> tuple[Diagnostic, ...]:
    """Return the faults for which something cannot be read; none where it is no file of a model."""
    if error.diagnostics or not error.code:
        return error.diagnostics
    place = Place(error.file, error.line)
    return (explained(Diagnostic(error.code, Severity.ERROR, error.reason, place)),)


def is_refusal(fault: Diagnostic) -> bool:
    """Return whether a fault keeps a whole file from being read."""
    return fault.code.startswith("FIL") or fault.code == "PRJ003"


def explained(fault: Diagnostic) -> Diagnostic:
    """Return a fault with what its code expects, and with its code's hint if it has none of its own."""
    code = CODES.get(fault.code)
    if code is None or code.brief:
        return fault
    return replace(fault, expected=fault.expected or code.expected, hint=fault.hint or code.hint)
