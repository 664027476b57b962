"""Plans in which robots stay as relays are verified by a check that knows nothing of how they came about."""

from collections import Counter
from dataclasses import replace
from math import inf

import numpy as np
from plain_scenes import DRONE, robot, scene, visit

from mmrs_core.analysis.checks import CHECKS
from mmrs_core.analysis.verdicts import verify
from mmrs_core.behaviour.reading import program_of
from mmrs_core.contributions.checks import CheckInput, Status
from mmrs_core.errors import InfeasibleError
from mmrs_core.languages.registry import core_registry
from mmrs_core.planning.planner import plan
from mmrs_core.scene import Await, Part, Stroke, Work
from mmrs_core.scene.relays import RELAY
from mmrs_core.scene.timing import LegTiming
from mmrs_core.transformation.engine import transform
from mmrs_core.transformation.kinds import MOVE_KINDS, PLAIN_ROBOT, ROBOT

SEEDS = range(40)
LEVEL = replace(
    DRONE,
    floor=0.0,
    ceiling=0.0,
    launches=False,
    endurance=inf,
    energy=inf,
    timing=LegTiming(3.0, spread=0.2),
)


def made_from(seed):
    """Return a scene with up to two relays of robots, relays of the context and tasks all over."""
    random = np.random.default_rng(seed)

    def place(least, most):
        away, angle = random.uniform(least, most), random.uniform(0.0, 1.2)
        return (float(away * np.cos(angle)), float(away * np.sin(angle)), 0.0)

    part = Part((ROBOT,), {"communicationRange": 100.0, "relayRange": float(random.uniform(80.0, 120.0))})
    robots = []
    for i in range(int(random.integers(2, 5))):
        one = robot(f"r{i}", (12.0 * i, -12.0 * (i % 2), 0.0), kinematics=LEVEL)
        robots.append(
            replace(one, type=replace(one.type, metaclasses=(ROBOT,), half_diagonal=0.5, part=part))
        )
    works = {f"t{i}": visit(place(10.0, 190.0), hold=5.0) for i in range(int(random.integers(1, 6)))}
    for i in range(int(random.integers(1, 3))):
        stroke = Stroke((place(60.0, 95.0 + 60.0 * i),))
        works[f"relay {i}"] = Work((stroke,), divisible=False, rule="any", relays=True)
    mast = Part((RELAY,), {"name": "mast", "position": place(50.0, 100.0), "range": 60.0})
    more = {"elements": (mast,) if random.random() < 0.3 else ()}
    more |= {"minimum_separation": 3.0} if random.random() < 0.5 else {}
    return scene(robots, works, position_error=float(random.choice([0.0, 0.5])), **more)


def verdicts_of(whole, found):
    kind = replace(PLAIN_ROBOT, name="kind", kinematics=lambda robot, scene: LEVEL)
    behaviour, _ = transform(whole, found, rules={}, robot_kinds={ROBOT: kind}, registry=core_registry())
    input = CheckInput(
        program=program_of(behaviour, registry=core_registry()),
        types={each.type.name: each.type for each in whole.robots},
        robot_kinds={ROBOT: kind},
        move_kinds={each.metaclass: each for each in MOVE_KINDS},
        areas=(),
        elements=whole.elements,
    )
    names = ("range", "synchronisation", "separation")
    return verify(input, [each for each in CHECKS if each.name in names])


def test_every_plan_with_relays_is_safe_and_many_have_robots_that_wait_for_them():
    seen = Counter()
    for seed in SEEDS:
        whole = made_from(seed)
        try:
            found = plan(whole)
        except InfeasibleError:
            seen["refused"] += 1
            continue
        broken = [
            each.message
            for each in verdicts_of(whole, found)
            if each.status not in (Status.SAFE, Status.NOT_CHECKED)
        ]
        assert broken == [], seed
        waits = any(isinstance(step, Await) and step.signals for each in found.robots for step in each.steps)
        seen["waiting" if waits else "near"] += 1
    assert seen["waiting"] >= 8, seen
