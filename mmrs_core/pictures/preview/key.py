"""Explains the signs of a map on a page."""

from __future__ import annotations

from mmrs_core.pictures.preview.markup import element, text
from mmrs_core.pictures.preview.picture import Picture
from mmrs_core.pictures.preview.signs import sign, symbols_in

_FLOWN_KEY = (
    ("planned", "pale: as planned"),
    ("response", "dotted: not in the plan"),
    ("photo", "photo"),
    ("missing", "photo not confirmed"),
    ("fault", "fault"),
)


def key_markup(picture: Picture) -> str:
    """Return the list of signs with what they mean."""
    rows = (
        ("work", "thick line: doing a task"),
        ("transit", "thin line: on the way"),
        ("action", "dot: device action"),
        ("stay", "ring: stays here"),
        ("home", "home"),
        ("forbidden", "forbidden area"),
        ("obstacle", "obstacle"),
        ("kept", "kept clear"),
        ("emergency", "emergency area"),
        *(_FLOWN_KEY if picture.flown else ()),
    )
    signs = (element("li", None, sign(symbol), text(symbol.label)) for symbol in symbols_in(picture))
    return element(
        "ul", {"class": "key"}, (f'<li><i class="{name}"></i>{words}</li>' for name, words in rows), signs
    )
