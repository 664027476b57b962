import pytest


@pytest.fixture(scope="session")
def contributions():
    """Return what the installed plug-ins contribute."""
    from mmrs_core.plugins import load_plugins

    return load_plugins().contributions
