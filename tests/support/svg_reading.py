"""What is in a drawing: its elements by class, and what they say for the pointer."""

from lxml import etree

SVG = "{http://www.w3.org/2000/svg}"


def parsed(markup: str) -> etree._Element:
    """Return the root of a drawing."""
    return etree.fromstring(markup.encode())


def with_class(drawing: str | etree._Element, kind: str) -> list[etree._Element]:
    """Return the elements of a class, of a drawing or of a part of one."""
    root = parsed(drawing) if isinstance(drawing, str) else drawing
    return [e for e in root.iter() if isinstance(e.tag, str) and kind in e.get("class", "").split()]


def tip(element: etree._Element) -> str | None:
    """Return what an element says for the pointer."""
    return element.findtext(f"{SVG}title")
