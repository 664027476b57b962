"""Metamodels loaded by pyecore, several at once, which may refer to each other in circles."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from inspect import isdatadescriptor, ismodule
from io import BytesIO
from pathlib import Path
from threading import RLock
from typing import Any

from pyecore import ecore
from pyecore.resources.resource import URI
from pyecore.resources.xmi import XMIResource

from mmrs_core.errors import MmrsError, PluginError
from mmrs_core.languages.datatypes import ECORE, XML_TYPES, declared_type
from mmrs_core.languages.metaclass import Package
from mmrs_core.languages.metamodels.ecore_file import EcoreNode
from mmrs_core.languages.metamodels.ecore_itself import built_in
from mmrs_core.languages.metamodels.forms import Forms
from mmrs_core.languages.metamodels.locating import Address, Directory, Located, located_in
from mmrs_core.languages.naming import nearest

DEEPEST_INHERITANCE = 100
MOST_WAYS = 20_000
"""From a class to all that it inherits from; pyecore goes every way."""

_PYTHONS = frozenset(name for name, held in vars(type).items() if isdatadescriptor(held))
_RESERVED = frozenset((*dir(ecore.EObject), *vars(ecore.EObject()), *_PYTHONS, "_staticEClass"))
_OF_ENUMERATIONS = frozenset((*dir(ecore.EEnum), *vars(ecore.EEnum("E"))))
_MAP_ENTRIES = ("EStringToStringMapEntry", "EFeatureMapEntry")
"""Classes of Ecore that pyecore has as data types."""
_ONE_AT_A_TIME = RLock()
"""pyecore changes its own classes for a moment where Python has no order for the supertypes of one."""


@dataclass(frozen=True, slots=True)
class LoadedPackages:
    """What was loaded.

    Attributes:
        packages: by nsURI.
        nodes: the package and the element of each class and feature, for messages.
    """

    packages: Mapping[str, ecore.EPackage]
    nodes: Mapping[Address, tuple[Located, EcoreNode]] = field(default_factory=dict)


def load(located: Sequence[Located], known: Iterable[Package], *, lenient: bool = False) -> LoadedPackages:
    """Load packages with pyecore.

    Args:
        located: packages of .ecore files, and EPackages, which are taken as they are.
        known: packages that stand, which the others may refer to.
        lenient: let a stand-in that has nothing but a name be for a class that is not at hand.

    Raises:
        UnreadableError: if a file has content that an .ecore file cannot have.
        PluginError: if a class is not at hand, or inherits from itself.
    """
    packages = tuple(known)
    given = {entry.ns_uri: _given(entry) for entry in located if entry.file is None}
    files = [entry for entry in located if entry.file is not None]
    if not files:
        return LoadedPackages(given)
    forms = Forms(Directory(located, packages, lenient), files, _RESERVED, _OF_ENUMERATIONS)
    text = forms.document()
    _check_inheritance(forms)
    finder = _Finder(forms, packages, given, lenient)
    resource = _Resource(_Text(text), finder)
    finder.resource = resource
    with _ONE_AT_A_TIME, _usual_order():
        try:
            resource.load()
        except (MmrsError, MemoryError):
            raise
        except Exception as fault:  # whatever a strange file does to it
            names = ", ".join(dict.fromkeys(entry.file.name for entry in files if entry.file is not None))
            reason = "nested too deeply for it" if isinstance(fault, RecursionError) else fault
            raise PluginError(f"{names}: pyecore cannot load this: {reason}") from fault
        else:
            finder.finish()
        finally:
            finder.forget()
    _give_files(files, resource.contents)
    return LoadedPackages({**given, **finder.packages}, forms.nodes)


def load_alone(path: Path) -> list[Any]:
    """Return the EPackages at the top of a file, with stand-ins for the classes of all other files.

    Raises:
        UnreadableError: if it is not a metamodel.
        PluginError: if a class is missing in it, or inherits from itself.
    """
    located = located_in(path, path.name)
    packages = load(located, (), lenient=True).packages
    return [packages[entry.ns_uri] for entry in located if not entry.parent]


def _given(entry: Located) -> ecore.EPackage:
    """Return the EPackage with the nsURI in the one that was handed in."""
    pending: list[Any] = [entry.ecore]
    while pending:
        epackage = epackage_of(pending.pop())
        if epackage.nsURI == entry.ns_uri:
            return epackage
        pending.extend(epackage.eSubpackages)
    raise PluginError(f"{entry.provider}: {entry.ns_uri}: not in the EPackage that was handed in")


def epackage_of(given: Any) -> Any:
    """Return the EPackage itself, where a module is one, as those that pyecoregen writes are."""
    return given.eClass if ismodule(given) else given


class _Text(URI):  # type: ignore[misc]  # pyecore has no types
    """A text in memory that stands in for a file."""

    def __init__(self, data: bytes) -> None:
        super().__init__("metamodels")
        self._data = data

    def create_instream(self) -> BytesIO:
        """Return the text as pyecore reads it."""
        return BytesIO(self._data)


class _Resource(XMIResource):  # type: ignore[misc]  # pyecore has no types
    """The document of all files; what its references lead to is found without pyecore's search."""

    def __init__(self, uri: URI, find: Callable[[str], Any]) -> None:
        super().__init__(uri)
        self._find = find

    def resolve(self, fragment: str, resource: object = None) -> Any:
        """Return what a reference leads to."""
        return self._find(fragment)


class _Finder:
    """Finds the objects that references in the text of `Forms` lead to."""

    def __init__(
        self, forms: Forms, known: Sequence[Package], given: Mapping[str, Any], lenient: bool
    ) -> None:
        self.packages: dict[str, Any] = {}
        self.resource: Any = None
        self._forms = forms
        self._lenient = lenient
        self._strangers: dict[str, Any] = {}
        self._outside: dict[Address, Any] = {
            (package.nsURI, kind.name): kind
            for package in (*(each.epackage for each in known), *given.values())
            if package.nsURI not in (ECORE, XML_TYPES)
            for kind in package.eClassifiers
        }
        self._inside: dict[Address, Any] = {}
        self._entered = False
        self._reached: dict[int, Any] = {}

    def __call__(self, token: str) -> Any:
        """Return what the reference of that number leads to.

        Raises:
            PluginError: if there is nothing of that name, with the nearest.
        """
        self._enter()
        address, kind, entry, node = self._forms.targets[int(token[1:])]
        found = self._inside.get(address)
        if found is None:
            found = self._outside.get(address) or _of_ecore(address) or self._feature(address)
            if found is None and self._lenient:
                found = self._stand_in(address, kind)
            if found is None:
                entry.refuse(self._no_such(address, node), node)
            self._reached[id(found)] = found
        if not isinstance(found, getattr(ecore, kind)):
            entry.refuse(f"{self._where(node)}: {address[-1]} is no {kind}", node)
        if kind == "EReference" and address not in self._inside and not self._lenient:
            # pyecore would change it for everybody
            opposite = f"{address[1]}.{address[2]}"
            entry.refuse(f"{self._where(node)}: its opposite {opposite} does not name it back", node)
        return found

    def _enter(self) -> None:
        """Note all that the document holds, once it is there."""
        if self._entered:
            return
        self._entered = True
        names = self._forms.names
        pending = list(self.resource.contents)
        while pending:
            package = pending.pop()
            self.packages[package.nsURI] = package
            pending += package.eSubpackages
            for kind in package.eClassifiers:
                self._inside[package.nsURI, kind.name] = kind
                for feature in getattr(kind, "eStructuralFeatures", ()):
                    name = names.get(feature.name, feature.name)
                    self._inside[package.nsURI, kind.name, name] = feature

    def _feature(self, address: Address) -> Any:
        owner = self._outside.get(address[:2]) if len(address) == 3 else None
        return owner and next((each for each in owner.eStructuralFeatures if each.name == address[2]), None)

    def _stand_in(self, address: Address, kind: str) -> Any:
        if kind == "EReference":
            return ecore.EReference(address[2])
        package = self._strangers.setdefault(address[0], ecore.EPackage(address[0], nsURI=address[0]))
        made = ecore.EDataType(address[1]) if kind == "EDataType" else ecore.EClass(address[1])
        package.eClassifiers.append(made)
        self._outside[address] = made
        return made

    def _where(self, node: EcoreNode) -> str:
        return next(".".join(known[1:]) for known, (_, each) in self._forms.nodes.items() if each is node)

    def _no_such(self, address: Address, node: EcoreNode) -> str:
        ns_uri, name = address[:2]
        where = self._where(node)
        if len(address) == 3:
            return f"{where}: {'#//'.join(address[:2])}/{address[2]}: no such reference"
        if name == "EFeatureMapEntry":
            reason = "a feature map, which models here cannot hold; use a reference to a common supertype"
            return f"{where}: {reason}"
        known = (each[1] for each in (*self._inside, *self._outside) if len(each) == 2 and each[0] == ns_uri)
        hint = nearest(name, list(known))
        return f"{where}: no type {name} in {ns_uri}{hint and '; ' + hint}"

    def finish(self) -> None:
        """Give everything what the text could not say."""
        self._enter()
        for made in self._inside.values():
            if isinstance(made, ecore.EEnum):
                _name_literals(made, self._forms.names)
            elif isinstance(made, ecore.EDataType):
                _give_values(made)
            elif isinstance(made, ecore.EStructuralFeature) and made.name in self._forms.names:
                delattr(made.eContainingClass.python_class, made.name)
                made.name = self._forms.names[made.name]
        for address, keys in self._forms.keys.items():
            found = [self._inside.get(key) or self._feature(key) for key in keys]
            self._inside[address].eKeys = [key for key in found if key is not None]
            if None in found and not self._lenient:
                entry, node = self._forms.nodes[address]
                entry.refuse(self._no_such(keys[found.index(None)], node), node)

    def forget(self) -> None:
        """Let what stands outside forget what was loaded, also where that was refused."""
        own = {id(each) for each in self._inside.values()}
        for reached in self._reached.values():  # pyecore would keep each metamodel as long as Ecore itself
            rels = reached._inverse_rels
            rels.difference_update([pair for pair in rels if id(pair[0]) in own])


def _of_ecore(address: Address) -> Any:
    """Return what pyecore itself has of Ecore, else what it lacks, such as the types of XML."""
    if address[0] not in (ECORE, XML_TYPES):
        return None
    own: Any = ecore.getEClassifier(address[1]) if address[0] == ECORE else None
    if own is not None and address[1] not in _MAP_ENTRIES:
        return own if isinstance(own, ecore.EDataType) else own.eClass
    package = next(each for each in built_in() if each.nsURI == address[0])
    return package.getEClassifier(address[1])


def _name_literals(enumeration: Any, names: Mapping[str, str]) -> None:
    """Let an enumeration read literals, as EMF does, and not names only."""
    for literal in enumeration.eLiterals:
        literal.name = names.get(literal.name, literal.name)
    texts = {literal.literal: literal for literal in enumeration.eLiterals if literal.literal is not None}
    by_name = enumeration.getEEnumLiteral
    enumeration.from_string = lambda text: texts.get(text) or by_name(name=text)


def _give_values(kind: Any) -> None:
    """Let a data type that a package declares read and write values as Java's class of them does."""
    known = declared_type(kind.ePackage.nsURI, kind.name, kind.instanceClassName or "")
    kind.eType, kind.type_as_factory, kind.default_value = known.python, False, known.primitive_default
    kind.from_string, kind.to_string = known.parse, known.render


def _give_files(files: Iterable[Located], contents: Sequence[Any]) -> None:
    """Let each package at the top of a file be in the resource of that file."""
    resources: dict[str, Any] = {}
    tops = [entry for entry in files if not entry.parent]
    for entry, package in zip(tops, list(contents), strict=True):
        place = str(entry.path)
        resource = resources.setdefault(place, XMIResource(URI(place)))
        resource.append(package)


def _check_inheritance(forms: Forms) -> None:
    """Refuse classes that inherit from themselves, or through more others than pyecore supports.

    Raises:
        PluginError: for the first such class.
    """
    try:
        order = tuple(TopologicalSorter(forms.supertypes).static_order())
    except CycleError as fault:
        address = fault.args[1][0]
        entry, node = forms.nodes[address]
        entry.refuse(f"class {address[1]} inherits from itself", node)
    depths: dict[Address, int] = {}
    ways: dict[Address, int] = {}
    for address in order:
        if address not in forms.supertypes:
            continue  # it stands already
        above = [each for each in forms.supertypes[address] if each in depths]
        depths[address] = 1 + max((depths[each] for each in above), default=0)
        ways[address] = 1 + sum(ways[each] for each in above)
        entry, node = forms.nodes[address]
        if depths[address] > DEEPEST_INHERITANCE:
            entry.refuse(f"class {address[1]} inherits through more than {DEEPEST_INHERITANCE} others", node)
        if ways[address] > MOST_WAYS:
            entry.refuse(f"class {address[1]} inherits in more than {MOST_WAYS} ways", node)


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
