"""Documentation of a metamodel as docstrings."""

from __future__ import annotations


def docstring(text: object, indent: int = 0) -> str:
    """Return a text as a docstring that nothing in the text can end, its further lines indented."""
    safe = str(text).strip().replace("\\", "\\\\")
    if '"""' in safe or safe.endswith('"'):
        safe = safe.replace('"', '\\"')
    lines = [line.strip() for line in safe.splitlines()]
    body = f"\n{' ' * indent}".join(lines).replace(f"\n{' ' * indent}\n", "\n\n")
    shown = (each if each.isprintable() or each == "\n" else ascii(each)[1:-1] for each in body)
    return f'"""{"".join(shown)}"""'
