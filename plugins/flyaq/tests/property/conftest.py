"""The shipped mapping, and what a migration says as plain text."""

import pytest
from mmrs_flyaq.migrate import migrate

from mmrs_core.languages.writing import to_xmi


@pytest.fixture(scope="session")
def said(mapping, registry, tmp_path_factory):
    """Return a function that migrates the text of a file: the models that come of it, and what is told."""
    folder = tmp_path_factory.mktemp("sources")

    def say(name, text, *others):
        file = folder / name
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
        found = migrate([file, *others], mapping, registry)
        models = [(str(output.path), to_xmi((output.element,), registry)) for output in found.outputs]
        told = [(each.category, each.reason, each.subject) for each in found.findings]
        return models, told, [source.fault for source in found.sources]

    return say
