"""Plans that are judged before anything else is asked of them."""

from plan_replay import complaints

from mmrs_core.planning.planner import plan


def steps_of(found, name, kind):
    """Return the steps of that kind of one robot, in order."""
    return [
        step for each in found.robots if each.robot == name for step in each.steps if isinstance(step, kind)
    ]


def sound(whole, **features):
    """Return the plan of a scene, which nothing is to be said against."""
    found = plan(whole, **features)
    assert complaints(whole, found) == []
    return found
