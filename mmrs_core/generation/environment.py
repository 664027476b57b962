"""The template engine: strict, and closed to values that no filter has encoded."""

from __future__ import annotations

from collections.abc import Callable

from jinja2 import Environment, FileSystemLoader, StrictUndefined, TemplateError, Undefined

from mmrs_core.contributions.targets import Target
from mmrs_core.errors import InternalError
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
    filters: dict[str, Callable[[object], str]] = {
        "py": python_literal,
        "json": json_literal,
        "comment": comment,
        "cell": cell,
        "identifier": identifier,
        "name": name,
        **target.filters,
    }
    environment.filters["py_lines"] = python_lines
    environment.filters.update({key: _coded(encode) for key, encode in filters.items()})
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


def _coded(encode: Callable[[object], str]) -> Callable[[object], Code]:
    def coded(value: object) -> Code:
        if isinstance(value, Undefined):
            str(value)
        return Code(encode(value))

    return coded
