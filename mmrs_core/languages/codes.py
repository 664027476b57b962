"""The codes of all faults that reading and checking against the metamodels can report."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

CODES: Mapping[str, str] = MappingProxyType(
    {
        "XMI001": "the metamodel of an element is not installed",
        "XMI002": "a metamodel has no class of that name",
        "XMI003": "an element of an abstract class",
        "XMI004": "an element has something that its class does not know",
        "XMI005": "a value that its type does not allow",
        "XMI006": "a reference that leads to no element",
        "XMI007": "a reference to a file that may not be opened",
        "XMI008": "an element of the wrong class, contained or referred to",
        "XMI009": "several values where one is allowed",
        "XMI010": "text where only elements may stand, or the reverse",
        "XMI011": "an extension of XMI that is not read",
        "XMI012": "an id that two elements of a file have",
        "XMI013": "the two ends of a reference contradict each other",
        "XMI014": "a namespace prefix that is not declared",
        "XMI015": "a root element without a namespace",
        "XMI016": "a reference to a file that cannot be read",
        "XMI017": "an element of another file that cannot be contained here",
        "ECO001": "a required value is missing",
        "ECO002": "too few or too many values",
        "ECO003": "a value of the wrong type",
        "ECO004": "a value that is not a literal of its enumeration",
        "ECO005": "an element of the wrong class",
        "ECO006": "the same value twice among values that must differ",
        "ECO007": "an element that its container does not know, or that two contain",
        "ECO008": "a reference to an element that stands in no model",
        "ECO009": "a number that is not finite",
        "ECO010": "an element of a metamodel that is not installed",
        "ECO011": "a reference whose other end does not refer back",
        "ECO012": "an identifier that two elements of a model have",
        "MIG001": "a model of an older version of its language, migrated while it was read",
        "MIG002": "a value that the newer version of a language has no place for",
        "PRJ001": "two types of robot of one name",
        "PRJ002": "a file of a project that does not hold what belongs there",
    }
)
