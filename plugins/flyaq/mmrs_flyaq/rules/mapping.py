"""A mapping as it is applied: for each class of a dialect what it becomes, for each feature where it goes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from mmrs_flyaq.rules.paths import FeaturePath
from mmrs_flyaq.sources.documents import KnownDocument
from mmrs_flyaq.sources.metamodels import Dialect
from mmrs_flyaq.sources.structure import Structure

Constant = str | float | bool


@dataclass(frozen=True, slots=True)
class Also:
    """Further paths for a value, where the source says something else, too.

    Attributes:
        given: the source features that have to hold something other than 0.
        to: paths in the new element.
    """

    given: tuple[str, ...]
    to: tuple[FeaturePath, ...]


@dataclass(frozen=True, slots=True)
class Make:
    """An element that is made where the source has none.

    Attributes:
        to: (nsURI, name) of its class.
        set: its values, by path in it.
    """

    to: tuple[str, str]
    set: Mapping[FeaturePath, Constant]


@dataclass(frozen=True, slots=True)
class Counterpart:
    """Refer to the element of the same name in other owners.

    Attributes:
        of: the source feature that refers to the owners; empty: the owner of the element itself.
        within: the feature of an owner that holds such elements.
        make: one is made where it is missing.
    """

    of: str
    within: str
    make: bool


@dataclass(frozen=True, slots=True)
class Bearing:
    """Turn an angle clockwise from north into a heading to a place far away in that direction.

    Attributes:
        base: ``self``: the position is seen from the coordinate that the angle stands in, and the heading is
            that of the element around it; ``home``: seen from the robot's home, for the element itself.
        distance: how far away, metres.
    """

    base: str = "home"
    distance: float = 0.0


@dataclass(frozen=True, slots=True)
class Use:
    """What becomes of a feature's values.

    Attributes:
        to: paths in the new element, such as ``speed.max``; none where it is dropped.
        also: further paths, on a condition.
        drop: why it is not carried over.
        times: what numbers are multiplied by.
        values: new texts by old ones.
        absent: what the target gets where the source has nothing; may hold ``{feature}`` and ``{number}``.
        make: the element that the target gets where the source has none.
        first_of: a source feature whose first element the target gets where the source has none.
        void: texts that mean that nothing is known.
        changed: how the meaning has changed.
        rule: the variant of the rule (written ``as``) by which contained elements are turned, or empty.
        beside: a source feature (written ``with``) whose use takes care of this one, too.
        given: a source feature without which this one is left out.
        below: a source feature that this number has to be less than, or it is left out.
        distinct: leave out an element that equals the one before it.
        widen: metres by which a border without an area is widened; 0: it stays as it is.
        hoist: the feature of the root that gets what is contained, or made on the way of a path, and is
            then referred to.
        unique: make texts unique among siblings by a number behind them.
        robot_type: the text names a robot type.
        otherwise: the robot type that stands in for one that is not known; empty: none does.
    """

    to: tuple[FeaturePath, ...] = ()
    also: Also | None = None
    drop: str = ""
    times: float = 1.0
    values: Mapping[str, str] = field(default_factory=dict)
    absent: Constant | None = None
    make: Make | None = None
    first_of: str = ""
    void: tuple[str, ...] = ()
    changed: str = ""
    rule: str = ""
    beside: str = ""
    given: str = ""
    below: str = ""
    distinct: bool = False
    widen: float = 0.0
    hoist: str = ""
    counterpart: Counterpart | None = None
    bearing: Bearing | None = None
    unique: bool = False
    robot_type: bool = False
    otherwise: str = ""


@dataclass(frozen=True, slots=True)
class Wait:
    """An element that becomes a condition of transitions.

    Attributes:
        slot: the source feature that refers to what is waited for.
        at: by the feature that holds the element, the ends of the transitions that wait.
        among: the feature of the owner that holds the transitions.
        add: the feature of a transition that gets the slot.
    """

    slot: str
    at: Mapping[str, tuple[str, ...]]
    among: str
    add: str


@dataclass(frozen=True, slots=True)
class Ring:
    """A circular move, whose target is the centre, that becomes way points.

    Attributes:
        radius, height, clockwise: the source features that describe the circle.
        duration: the source feature that says for how many seconds; empty: one round, however long it takes.
        points: how many way points a round has.
    """

    radius: str
    height: str
    clockwise: str
    duration: str
    points: int = 12


@dataclass(frozen=True, slots=True)
class DeviceLookup:
    """Find the device of the robot's type that does an action; without one, the element is left out.

    Attributes:
        action: the source feature that names the action.
        to: where the device's id goes in the new element.
    """

    action: str
    to: FeaturePath


@dataclass(frozen=True, slots=True)
class Rule:
    """What becomes of the elements of one class.

    Attributes:
        source: ``package.Class``, with ``/variant`` behind it for a rule that others ask for by name.
        to: (nsURI, name) of the new class; None where there is not an element of its own.
        drop: why it is not carried over.
        unreferred: why it is not carried over where nothing refers to it; empty: it is.
        merge: its features go into the element made of its container.
        set: constants by path in the new element.
        changed: how the meaning has changed.
        uses: by source feature, those of supertypes included.
        robot_type: it makes robot types, which others name.
    """

    source: str
    to: tuple[str, str] | None = None
    drop: str = ""
    unreferred: str = ""
    merge: bool = False
    set: Mapping[FeaturePath, Constant] = field(default_factory=dict)
    changed: str = ""
    uses: Mapping[str, Use] = field(default_factory=dict)
    wait: Wait | None = None
    ring: Ring | None = None
    device: DeviceLookup | None = None
    robot_type: bool = False


@dataclass(frozen=True, slots=True)
class DialectMapping:
    """A mapping file, read.

    Attributes:
        name: of the dialect.
        structure: its classes, for where no metamodel is at hand.
        rules: by ``package.Class`` and ``package.Class/variant``.
        types: names of robot types that stand for names which no robot type has.
        documents: files that are recognised by their form, the first that fits counts.
    """

    name: str
    dialect: Dialect
    structure: Structure
    rules: Mapping[str, Rule]
    types: Mapping[str, str] = field(default_factory=dict)
    documents: tuple[KnownDocument, ...] = ()

    def rule(self, kind: str, variant: str, structure: Structure) -> Rule | None:
        """Return the rule for a class: its own or that of the nearest supertype; None if there is none."""
        for ancestor in structure.ancestry(kind):
            found = (variant and self.rules.get(f"{ancestor}/{variant}")) or self.rules.get(ancestor)
            if found:
                return found
        return None

    def uses(self, kind: str, rule: Rule, structure: Structure) -> Mapping[str, Use]:
        """Return what becomes of every feature that the rule or those of the supertypes speak of."""
        found: dict[str, Use] = dict(rule.uses)
        for ancestor in structure.ancestry(kind):
            other = self.rules.get(ancestor)
            for feature, use in other.uses.items() if other else ():
                found.setdefault(feature, use)
        return found
