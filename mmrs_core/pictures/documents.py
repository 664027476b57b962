"""Renders the templates of pages and pictures; whatever comes from a model is escaped."""

from __future__ import annotations

import re
from functools import cache

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from mmrs_core.pictures.palette import COLOURS, fixed

_UNPRINTABLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ud800-\udfff\ufffe\uffff]")


def render(name: str, /, *, standalone: bool = False, **values: object) -> Markup:
    """Return a document made from a template; numbers are written with at most two decimals.

    Args:
        name: of the template, such as ``map.svg``.
        standalone: whether colours are written out, for a picture that stands in no page.
    """
    return Markup(_environment().get_template(f"{name}.j2").render(standalone=standalone, **values))


def style_sheets(*names: str, standalone: bool = False) -> Markup:
    """Return style sheets, one after the other, as they may stand in a ``style`` element."""
    sheets = "".join(source(f"{name}.css") for name in names)
    return Markup(fixed(sheets) if standalone else sheets)


def source(name: str) -> Markup:
    """Return a style sheet or script as it stands beside the templates."""
    environment = _environment()
    assert environment.loader is not None
    return Markup(environment.loader.get_source(environment, name)[0])


def number(value: float) -> str:
    """Return a coordinate with at most two decimals.

    >>> number(3.0), number(2.345), number(-0.001)
    ('3', '2.35', '0')
    """
    short = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if short == "-0" else short


def printable(value: object) -> object:
    """Return a value as a document may show it: characters that XML forbids become U+FFFD."""
    if isinstance(value, float):
        return number(value)
    if isinstance(value, str) and not isinstance(value, Markup):
        return _UNPRINTABLE.sub("\ufffd", value)
    return value


@cache
def _environment() -> Environment:
    environment = Environment(
        loader=PackageLoader("mmrs_core.pictures"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
        finalize=printable,
        auto_reload=False,
    )
    environment.filters["colour"] = _colour
    return environment


def _colour(name: str, standalone: bool) -> str:
    """Return a colour of the palette as an attribute holds it."""
    return COLOURS[name][0] if standalone else f"var(--{name})"
