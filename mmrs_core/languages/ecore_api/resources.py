"""Resources of pyecore that our reader fills and our writer saves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from io import TextIOBase
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pyecore.resources import URI, Resource

from mmrs_core.diagnostics import Diagnostic, Severity, has_errors
from mmrs_core.errors import InvalidModelError, UnreadableError, UnsupportedError
from mmrs_core.languages.codes import explained
from mmrs_core.languages.ecore_api.bridge import Outward, file_of, from_pyecore
from mmrs_core.languages.element import Element, metaclass_of, place_of, root_of
from mmrs_core.languages.json_form import is_json
from mmrs_core.languages.model import Model
from mmrs_core.languages.reading import read_model, read_text
from mmrs_core.languages.references.hrefs import real_path
from mmrs_core.languages.registry import Registry
from mmrs_core.languages.writing import replace_file, to_json, to_xmi

if TYPE_CHECKING:
    from mmrs_core.languages.importers import Importer


def resource_factory(registry: Registry, root: Path | None = None) -> Callable[..., ModelResource]:
    """Return what makes resources, for the ``resource_factory`` of a ``ResourceSet`` or of all of them.

    Args:
        registry: the metamodels that models may use.
        root: the folder that references must not leave; by default that of each file.
    """
    return partial(ModelResource, registry, root=root)


class ModelResource(Resource):  # type: ignore[misc]  # pyecore has no types
    """A file of a model, in XMI or in our form of JSON, whose contents are pyecore's objects.

    Attributes:
        notices: the diagnostics of the last load that are not errors.
        importer: what imported the file at the last load; None for a file in our own format.
    """

    def __init__(
        self, registry: Registry, uri: Any = None, use_uuid: bool = False, *, root: Path | None = None
    ) -> None:
        super().__init__(uri, use_uuid)
        self._registry = registry
        self._root = root
        self.notices: tuple[Diagnostic, ...] = ()
        self.importer: Importer | None = None

    def load(self, options: Mapping[object, object] | None = None) -> None:
        """Read the file, and those that it refers to into resources of the same set, unless open there.

        Raises:
            UnreadableError: if the file cannot be read at all.
            InvalidModelError: if any of the files has a fault; all faults are listed.
            UnsupportedError: if a model holds what pyecore cannot hold, as `to_pyecore`.
            ValueError: if there are options: the reader has none.
        """
        _refuse(options)
        model = self._read()
        faults = [fault for each in (model, *model.linked) for fault in each.diagnostics]
        if has_errors(faults):
            raise _invalid(faults)
        for root in (root for each in (model, *model.linked) for root in each.roots):
            if root._mmrs_container is not None:
                message = "the root of a file inside an element of another, which pyecore does not have"
                raise UnsupportedError(f"{place_of(root)}: {message}")
        known = self._open()
        files = [model, *(each for each in model.linked if real_path(Path(each.file)) not in known)]
        outward = Outward(lambda element: _present(element, known))
        for each in files:
            for root in each.roots:
                outward.tree(root)
        outward.connect()
        for each in files:
            resource = self if each is model else self._beside(str(each.file))
            resource._fill(each.roots, outward.made)
            resource.importer = each.importer
        self.notices = tuple(faults)

    def save(self, output: Any = None, options: Mapping[object, object] | None = None) -> None:
        """Write the contents into the file, or into another one: whole, or not at all.

        Args:
            output: another ``URI`` or path.
            options: none; the writer has none.

        Raises:
            UnsupportedError: if an object is of a class that the registry does not have, or the file was
                imported: it stays as it is.
            ValueError: if a value cannot be written, or a reference leads to an object in no file; options.
            OSError: if the file cannot be written.
        """
        _refuse(options)
        uri = self.uri if output is None else output if isinstance(output, URI) else URI(str(output))
        if self.importer and file_of(uri) == file_of(self.uri):
            message = f"a model of {self.importer.name}, which is not replaced; save it as another file"
            raise UnsupportedError(f"{self.uri.plain}: {message}")
        if self.use_uuid:
            for root in self.contents:
                for each in (root, *root.eAllContents()):
                    self._assign_uuid(each)
        roots = from_pyecore(self.contents, self._registry).roots
        file = file_of(uri)
        data = (to_json if is_json(uri.plain) else to_xmi)(roots, self._registry, file=file)
        if file is not None:
            replace_file(file, data)
            return
        stream = uri.create_outstream()
        stream.write(data.decode() if isinstance(stream, TextIOBase) else data)
        stream.flush()
        uri.close_stream()

    def _read(self) -> Model:
        if self.uri.protocol in ("http", "https"):
            raise UnreadableError(f"{self.uri.plain}: reading does not touch the network")
        if file_of(self.uri) is not None:
            path = Path(self.uri.plain if self.uri.protocol is None else self.uri.normalize())
            return read_model(path, self._registry, root=self._root)
        text = self.uri.create_instream().read()
        self.uri.close_stream()
        return read_text(text.encode() if isinstance(text, str) else text, self.uri.plain, self._registry)

    def _open(self) -> dict[Path | None, Resource]:
        """Return the resources of the same set that have contents already, by the real path of their file."""
        others = self.resource_set.resources.values() if self.resource_set is not None else ()
        open_ones = (other for other in others if isinstance(other, Resource) and other is not self)
        return {file: other for other in open_ones if other.contents and (file := file_of(other.uri))}

    def _beside(self, file: str) -> ModelResource:
        """Return a resource for another file, in the same set whatever the ending."""
        made = ModelResource(self._registry, URI(file), root=self._root)
        if self.resource_set is not None:
            self.resource_set.resources[made.uri.normalize()] = made
            made.resource_set = self.resource_set
            made.decoders.insert(0, self.resource_set)
        return made

    def _fill(self, roots: Sequence[Element], made: Mapping[int, Any]) -> None:
        self.extend(made[id(root)] for root in roots)
        source = roots[0]._mmrs_source if roots else None
        for element, identifier in source.ids.items() if source is not None else ():
            self.uuid_dict[identifier] = made[id(element)]
            made[id(element)]._internal_id = identifier
            if element in roots:
                self.use_uuid = True  # as pyecore does


def _present(element: Element, known: Mapping[Path | None, Resource]) -> Any:
    """Return the object that is where the element's file has it, in a resource that is open; otherwise None.

    Raises:
        InvalidModelError: if nothing is there any more.
    """
    source = root_of(element)._mmrs_source
    if source is None or source.path not in known:
        return None
    resource = known[source.path]
    try:
        identifier = source.ids.get(element)
        found = resource.uuid_dict.get(identifier) or resource.resolve(Element.eURIFragment(element))
    except (AttributeError, IndexError, ValueError):
        found = None
    metaclass, place = metaclass_of(element), place_of(element)
    if found is None or found.eClass is not metaclass.eclass:
        message = f"{metaclass.name}: there is none at {place.path} any more in the resource that is open"
        raise _invalid([explained(Diagnostic("XMI006", Severity.ERROR, message, place))])
    return found


def _invalid(faults: Sequence[Diagnostic]) -> InvalidModelError:
    errors = [fault for fault in faults if fault.severity is Severity.ERROR]
    more = f", and {len(errors) - 1} more" if len(errors) > 1 else ""
    return InvalidModelError(f"{errors[0].place}: {errors[0].message}{more}", faults)


def _refuse(options: Mapping[object, object] | None) -> None:
    if options:
        raise ValueError(f"{', '.join(map(str, options))}: our reader and writer take no options")
