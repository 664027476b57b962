"""Finds blocks of templates that fill nothing: in what they extend, there is no block of that name."""

from __future__ import annotations

from jinja2 import Environment, TemplateError, nodes

from mmrs_core.errors import MmrsError
from mmrs_core.generation.overrides import Overrides


def check_blocks(environment: Environment, overrides: Overrides) -> None:
    """Require that each block of a template that extends another replaces one there.

    Raises:
        MmrsError: if one does not; names the blocks that there are.
    """
    for name in overrides.hashes:
        if not name.endswith(".jinja"):
            continue
        try:
            tree, above = _parsed(environment, name), _blocks_above(environment, name)
        except (TemplateError, UnicodeDecodeError):
            continue  # what cannot be read is told, with its line, when it is rendered
        if above is None:
            continue
        for block in (node for node in tree.body if isinstance(node, nodes.Block)):
            if block.name not in above:
                there = f"there are {', '.join(sorted(above))}" if above else "there is none"
                raise MmrsError(
                    f"{overrides.folder / name}, line {block.lineno}: what it extends has no block"
                    f" '{block.name}'; {there}"
                )


def _blocks_above(environment: Environment, name: str) -> set[str] | None:
    """Return the blocks of all that a template extends; None where it extends nothing that is known."""
    parent = _parent(_parsed(environment, name))
    if parent is None:
        return None
    own = {block.name for block in _parsed(environment, parent).find_all(nodes.Block)}
    return own | (_blocks_above(environment, parent) or set())


def _parent(tree: nodes.Template) -> str | None:
    extends = tree.find(nodes.Extends)
    found = (
        extends.template.value if extends is not None and isinstance(extends.template, nodes.Const) else None
    )
    return found if isinstance(found, str) else None


def _parsed(environment: Environment, name: str) -> nodes.Template:
    assert environment.loader is not None
    source, _, _ = environment.loader.get_source(environment, name)
    return environment.parse(source, name)
