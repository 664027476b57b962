"""The template engine: strict, and closed to values that no filter has encoded."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from traceback import extract_tb

from jinja2 import (
    BaseLoader,
    ChoiceLoader,
    Environment,
    FileSystemLoader,
    PrefixLoader,
    StrictUndefined,
    TemplateError,
    TemplateNotFound,
    TemplateSyntaxError,
    Undefined,
)

from mmrs_core.contributions.targets import Target
from mmrs_core.errors import InternalError, MmrsError
from mmrs_core.generation.escaping import (
    Code,
    cell,
    comment,
    identifier,
    json_literal,
    name,
    python_lines,
    python_literal,
)
from mmrs_core.generation.overrides import Overrides
from mmrs_core.generation.tracing import Served, Serves, taken_out, unforged
from mmrs_core.resources import shipped

SHIPPED = "shipped"
"""Before the name of a template: the target's own, also where another takes its place."""

PYTHON = "python"
"""Before the name of a template: the core's for programs in Python, which any target may use."""


class _Rendered(Code):
    """Text that was rendered already, such as a block of a shipped template: marks and all."""

    __slots__ = ()


class _Environment(Environment):
    """An environment in which what blocks and macros return may be written as it is."""

    @staticmethod
    def concat(parts: Iterable[str]) -> str:
        """Return what a block or a macro has rendered, as one text."""
        return _Rendered("".join(parts))


def environment_of(target: Target, overrides: Overrides | None = None) -> Environment:
    """Return the environment in which a target's templates are rendered, or those that take their place.

    Without overrides it is the same one each time, so that a template is compiled once.
    """
    if overrides is not None:
        return _environment(target, overrides)
    kept = _KEPT.get(target.templates)
    if kept is None or kept[0] != target.filters:
        kept = _KEPT[target.templates] = target.filters, _environment(target)
    return kept[1]


_KEPT: dict[Path, tuple[Mapping[str, Callable[[object], str]], Environment]] = {}
"""For each folder of templates, the filters of the target that rendered them last, and its environment."""


def _environment(target: Target, overrides: Overrides | None = None) -> Environment:
    environment = environment_in(target.templates, target.filters)
    common = FileSystemLoader(shipped("codegen_templates") / PYTHON)
    own = ChoiceLoader([FileSystemLoader(target.templates), common])
    found: list[BaseLoader] = [own, PrefixLoader({PYTHON: common})]
    if overrides is not None:
        found = [FileSystemLoader(overrides.folder), *found, PrefixLoader({SHIPPED: own})]
    environment.loader = ChoiceLoader(found)
    return environment


def environment_in(folder: Path, more: Mapping[str, Callable[..., str]]) -> Environment:
    """Return the environment in which the templates of a folder are rendered.

    Undefined names are errors, so is a value that is written without a filter.

    Args:
        folder: of the templates.
        more: filters beside the usual ones, by name.
    """
    environment = _Environment(
        loader=FileSystemLoader(folder),
        undefined=StrictUndefined,
        autoescape=False,
        finalize=_encoded,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        extensions=[Serves],
    )
    filters: dict[str, Callable[..., str]] = {
        "py": python_literal,
        "json": json_literal,
        "comment": comment,
        "cell": cell,
        "identifier": identifier,
        "name": name,
        **more,
    }
    environment.filters["py_lines"] = python_lines
    environment.filters.update({key: _coded(encode) for key, encode in filters.items()})
    return environment


def rendered(environment: Environment, template: str, view: object) -> str:
    """Return a template's text for a view; raises as `rendered_with_lines`."""
    return rendered_with_lines(environment, template, view)[0]


def rendered_with_lines(
    environment: Environment, template: str, view: object, overrides: Overrides | None = None
) -> tuple[str, tuple[Served, ...]]:
    """Return a template's text for a view, and which of its lines serve which steps.

    Raises:
        InternalError: the template is broken, or writes a value that no filter encoded.
        MmrsError: so does one of the templates that people put in its place.
    """
    try:
        return taken_out(environment.get_template(template).render(view))
    except (TemplateError, ValueError, TypeError, LookupError, ArithmeticError, AttributeError) as error:
        where = f"template {_place_of(error, template)}: {_words_of(error)}"
        if overrides is not None and overrides.hashes:
            raise MmrsError(f"{overrides.folder}: {where}") from error
        raise InternalError(where) from error


def _place_of(error: Exception, template: str) -> str:
    """Return the template and the line in which an error arose, as far as they are known."""
    if isinstance(error, TemplateSyntaxError):
        return f"{error.name or template}, line {error.lineno}"
    found = [frame for frame in extract_tb(error.__traceback__) if frame.filename.endswith(".jinja")]
    return f"{Path(found[-1].filename).name}, line {found[-1].lineno}" if found else template


def _words_of(error: Exception) -> str:
    return f"there is no template {error.name!r}" if isinstance(error, TemplateNotFound) else str(error)


def _encoded(value: object) -> object:
    if isinstance(value, _Rendered):
        return value
    if isinstance(value, Code):
        return unforged(value)
    raise ValueError(f"{value!r} is written without a filter that encodes it")


def _coded(encode: Callable[..., str]) -> Callable[..., Code]:
    def coded(value: object, *options: object) -> Code:
        if isinstance(value, Undefined):
            str(value)
        return Code(encode(value, *options))

    return coded
