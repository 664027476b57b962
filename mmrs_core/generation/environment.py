"""The template engine: strict, and closed to values that no filter has encoded."""

from __future__ import annotations

from collections.abc import Callable

from jinja2 import Environment, FileSystemLoader, StrictUndefined, TemplateError

from mmrs_core.contributions.targets import Target
from mmrs_core.errors import InternalError
from mmrs_core.generation.escaping import (
    Code,
    cell,
    comment,
    identifier,
    json_literal,
    name,
    python_literal,
)

Filter = Callable[[object], Code]


def environment_of(target: Target) -> Environment:
    """Return the environment in which a target's templates are rendered.

    Undefined names are errors, so is a value that is written without a filter.
    """
    environment = Environment(
        loader=FileSystemLoader(target.templates),
        undefined=StrictUndefined,
        autoescape=False,
        finalize=_encoded,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    own: dict[str, Filter] = {"py": python_literal, "json": json_literal, "comment": comment, "cell": cell}
    environment.filters.update(own | {"identifier": identifier, "name": name})
    environment.filters.update({name: _coded(encode) for name, encode in target.filters.items()})
    return environment


def rendered(environment: Environment, template: str, view: object) -> str:
    """Return a template's text for a view.

    Raises:
        InternalError: the template is broken, or writes a value that no filter encoded.
    """
    try:
        return environment.get_template(template).render(view)
    except (TemplateError, ValueError) as error:
        raise InternalError(f"template {template}: {error}") from error


def _encoded(value: object) -> object:
    if isinstance(value, Code):
        return value
    raise ValueError(f"{value!r} is written without a filter that encodes it")


def _coded(encode: Callable[[object], str]) -> Filter:
    return lambda value: Code(encode(value))
