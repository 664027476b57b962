"""The template engine: strict, and closed to values that no filter has encoded."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

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
    """Return the environment in which a target's templates are rendered."""
    return environment_in(target.templates, target.filters)


def environment_in(folder: Path, more: Mapping[str, Callable[..., str]]) -> Environment:
    """Return the environment in which the templates of a folder are rendered.

    Undefined names are errors, so is a value that is written without a filter.

    Args:
        folder: of the templates.
        more: filters beside the usual ones, by name.
    """
    environment = Environment(
        loader=FileSystemLoader(folder),
        undefined=StrictUndefined,
        autoescape=False,
        finalize=_encoded,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
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


def _coded(encode: Callable[..., str]) -> Callable[..., Code]:
    def coded(value: object, *options: object) -> Code:
        if isinstance(value, Undefined):
            str(value)
        return Code(encode(value, *options))

    return coded
