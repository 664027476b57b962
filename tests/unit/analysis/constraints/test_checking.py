"""What runs constraints."""

import pytest

from mmrs_core.analysis.constraints.findings import called, finding
from mmrs_core.contributions.constraints import Constraint
from mmrs_core.diagnostics import Severity
from mmrs_core.errors import InternalError, PluginError
from mmrs_core.languages import mission

VISIT = ("urn:test:trial", "Visit")
TASK = ("urn:mmrs:mission:1.0", "Task")


def complaint(metaclass, *, check=None, hint="mend it", severity=Severity.ERROR) -> Constraint:
    def grumble(element, models):
        yield finding(element, "is wrong")

    return Constraint("XYZ001", "Nothing is right.", metaclass, check or grumble, hint, severity)


def test_constraint_applies_to_subclasses_of_plugins(models):
    found = models.faults([complaint(TASK)])
    assert len(found) == len(models.mission.tasks)


def test_constraint_on_a_class_leaves_its_siblings_alone(models):
    assert {fault.place.path for fault in models.faults([complaint(VISIT)])} == {"/tasks[1]", "/tasks[5]"}


def test_diagnostic_carries_code_severity_place_and_hint(models):
    found = models.faults([complaint(VISIT, severity=Severity.WARNING)])[0]
    assert (found.code, found.severity, found.hint) == ("XYZ001", Severity.WARNING, "mend it")
    assert found.message == "Visit 'visit': is wrong"


def test_hint_of_a_finding_goes_before_that_of_the_constraint(models):
    def grumble(element, models):
        yield finding(element, "is wrong", "do this")

    assert models.faults([complaint(VISIT, check=grumble)])[0].hint == "do this"


def test_errors_come_before_warnings(models):
    models.task("visit").robotsWanted = 0
    models.context.obstacles[0].name = "meadow"
    assert [fault.code for fault in models.faults()] == ["MML062", "CTX002"]


def test_failing_constraint_is_our_fault_and_named(models):
    def fail(element, models):
        raise KeyError("oops")
        yield

    with pytest.raises(InternalError, match=r"XYZ001: fails on /tasks\[1\]"):
        models.faults([complaint(VISIT, check=fail)])


def test_constraint_on_a_class_that_its_metamodel_lacks_is_refused(models):
    with pytest.raises(PluginError, match="XYZ001"):
        models.faults([complaint(("urn:mmrs:mission:1.0", "Taks"))])


def test_constraint_on_a_metamodel_that_is_not_installed_is_passed_over(models):
    assert models.faults([complaint(("urn:test:absent", "Thing"))]) == ()


def test_edits_between_two_checks_are_seen(models):
    robots = models.mission.team.robots
    assert "MML080" not in models.codes()
    robots[0].home = models.at(205, 5)
    assert "MML080" in models.codes()


def test_elements_are_called_by_class_and_name_or_place(models):
    assert called(models.task("visit")) == "Visit 'visit'"
    assert called(models.task("visit").point) == "RelativeCoordinate tasks[1]/point"
    assert called(models.quad.size) == "size"
    assert called(mission.Mission()) == "Mission"
