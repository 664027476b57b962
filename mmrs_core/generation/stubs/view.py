"""What the stub of one package says, in the words of Python."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from mmrs_core.generation.escaping import python_literal
from mmrs_core.generation.stubs.names import Scope, member_names
from mmrs_core.languages.datatypes import BUILT_IN, DataType
from mmrs_core.languages.element import Element
from mmrs_core.languages.metaclass import Enumeration, Feature, Metaclass, Package


@dataclass(frozen=True, slots=True)
class FeatureView:
    """A feature as the template sees it: what it holds, and what a constructor takes for it.

    Attributes:
        hides: whether it has the name of a method of all elements, and goes first.
    """

    name: str
    held: str
    given: str
    documentation: str
    hides: bool


@dataclass(frozen=True, slots=True)
class ClassView:
    """A class as the template sees it; ``own`` are the features that it declares, ``all`` what it has."""

    name: str
    bases: str
    documentation: str
    receiver: str
    own: tuple[FeatureView, ...]
    all: tuple[FeatureView, ...]


@dataclass(frozen=True, slots=True)
class EnumerationView:
    """An enumeration as the template sees it."""

    name: str
    type: str
    documentation: str


def module_view(package: Package, modules: Mapping[str, str]) -> Mapping[str, object]:
    """Return what the template of a stub is filled with.

    Args:
        package: the metamodel.
        modules: the dotted name of the module for each nsURI that the metamodel refers to. One without
            a dot is imported as it is.
    """
    return _Module(package, modules).view()


class _Module:
    def __init__(self, package: Package, modules: Mapping[str, str]) -> None:
        self._package = package
        self._modules = modules
        self._names = member_names(package)
        self._lineage = Lineage()
        hidden = {feature.attribute for metaclass in package.metaclasses for feature in metaclass.features}
        self._scope = Scope(frozenset((*self._names.values(), "NS_URI")), frozenset(hidden))

    def view(self) -> Mapping[str, object]:
        final, string = self._scope.known("Final"), self._scope.known("str")
        enumerations = [self._enumeration(each) for each in self._package.enumerations]
        classes = [self._class(each) for each in self._package.metaclasses]
        aliases = [{"alias": alias, "name": name} for name, alias in self._scope.aliases().items()]
        return {
            "final": final,
            "string": string,
            "alias": self._scope.known("TypeAlias") if enumerations or aliases else "",
            "enumerations": enumerations,
            "classes": classes,
            "aliases": aliases,
            "imports": list(self._scope.import_lines()),
        }

    def _enumeration(self, enumeration: Enumeration) -> EnumerationView:
        names = ", ".join(python_literal(name) for name in enumeration.names)
        kind = f"{self._scope.known('Literal')}[{names}]" if names else self._scope.known("Never")
        return EnumerationView(self._names[enumeration.name], kind, enumeration.documentation)

    def _class(self, metaclass: Metaclass) -> ClassView:
        bases = ", ".join(map(self._base, self._lineage.bases(metaclass)))
        attributes = {feature.attribute for feature in metaclass.features}
        return ClassView(
            self._names[metaclass.name],
            bases or self._scope.known("Element"),
            metaclass.documentation,
            next(name for name in ("self", "_self", "_itself") if name not in attributes),
            tuple(map(self._feature, self._lineage.own_features(metaclass))),
            tuple(map(self._feature, metaclass.features)),
        )

    def _feature(self, feature: Feature) -> FeatureView:
        value = self._type(feature.type)
        if feature.many:
            held = f"{self._scope.known('list')}[{value}]"
            given = f"{self._scope.known('Iterable')}[{value}] | None"
        else:
            always = feature.required or feature.default is not None
            held, given = value if always else f"{value} | None", f"{value} | None"
        hides = feature.attribute in vars(Element)
        return FeatureView(feature.attribute, held, given, feature.documentation, hides)

    def _base(self, kind: Metaclass) -> str:
        """Return a class as the head of another names it, where no feature hides it."""
        return self._names[kind.name] if kind.ns_uri == self._package.ns_uri else self._type(kind)

    def _type(self, kind: Metaclass | DataType | Enumeration) -> str:
        if isinstance(kind, DataType):
            return self._scope.known(kind.python.__name__)
        if kind.ns_uri in BUILT_IN:
            return self._scope.known("Element")
        if kind.ns_uri == self._package.ns_uri:
            return self._scope.member(self._names[kind.name])
        parent, _, module = self._modules[kind.ns_uri].rpartition(".")
        home = self._package.known[kind.ns_uri]
        return f"{self._scope.imported(parent, module)}.{member_names(home)[kind.name]}"


def referred(package: Package) -> Iterable[str]:
    """Yield the nsURI of every other package whose classes or enumerations a package uses; some twice."""
    for metaclass in package.metaclasses:
        kinds = (*metaclass.supertypes, *(feature.type for feature in metaclass.features))
        for kind in kinds:
            if not isinstance(kind, DataType) and kind.ns_uri not in (*BUILT_IN, package.ns_uri):
                yield kind.ns_uri


class Lineage:
    """Finds which supertypes Python can have as bases: Ecore's order need not be one of Python's."""

    def __init__(self) -> None:
        self._shapes: dict[Metaclass, type] = {}

    def bases(self, metaclass: Metaclass) -> tuple[Metaclass, ...]:
        """Return the supertypes that can be bases together, in their order; the first always can.

        Those of Ecore itself have no stub, hence are none.
        """
        chosen: tuple[Metaclass, ...] = ()
        for above in dict.fromkeys(metaclass.supertypes):
            if above.ns_uri in BUILT_IN:
                continue
            if any(above.key in other.ancestry[1:] for other in metaclass.supertypes):
                continue
            if self._fit((*chosen, above)):
                chosen = (*chosen, above)
        return chosen

    def own_features(self, metaclass: Metaclass) -> tuple[Feature, ...]:
        """Return the features that none of the bases has."""
        inherited = {feature for base in self.bases(metaclass) for feature in base.features}
        return tuple(feature for feature in metaclass.features if feature not in inherited)

    def _fit(self, bases: tuple[Metaclass, ...]) -> bool:
        try:
            type("Shape", tuple(map(self._shape, bases)), {})
        except TypeError:
            return False
        return True

    def _shape(self, metaclass: Metaclass) -> type:
        if metaclass not in self._shapes:
            above = tuple(map(self._shape, self.bases(metaclass)))
            self._shapes[metaclass] = type(metaclass.name, above, {})
        return self._shapes[metaclass]


def docstring(text: object, indent: int = 0) -> str:
    """Return a text as a docstring that nothing in the text can end, its further lines indented."""
    safe = str(text).strip().replace("\\", "\\\\")
    if '"""' in safe or safe.endswith('"'):
        safe = safe.replace('"', '\\"')
    lines = [line.strip() for line in safe.splitlines()]
    body = f"\n{' ' * indent}".join(lines).replace(f"\n{' ' * indent}\n", "\n\n")
    shown = (each if each.isprintable() or each == "\n" else ascii(each)[1:-1] for each in body)
    return f'"""{"".join(shown)}"""'
