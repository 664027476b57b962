"""Examples whose texts are spoilt, and what quick fixes make of them."""

import pytest

from mmrs_core.analysis.fixes.repair import Repairer
from mmrs_core.cli.diagnosing import Subject
from mmrs_core.cli.session import Session
from mmrs_core.cli.settings import Settings


@pytest.fixture(scope="session")
def session():
    return Session(Settings())


@pytest.fixture(scope="session")
def examined(session):
    """Return a function: what repairs a project with other texts, and what is wrong with it."""

    def examine(file, unsaved, fixes=None):
        subject, contributions = Subject(session, file), session.contributions
        checks = [check.name for check in contributions.checks]

        def diagnose(more):
            return subject.diagnose({**unsaved, **more})

        chosen = contributions.fixes if fixes is None else {fix.code: fix for fix in fixes}
        return Repairer(chosen, contributions.languages, checks, diagnose), diagnose({})

    return examine


@pytest.fixture(scope="session")
def mended(examined):
    """Return a function: the repair of a project with other texts."""

    def mend(file, unsaved, fixes=None):
        repairer, now = examined(file, unsaved, fixes)
        return repairer.repair(now, unsaved)

    return mend
