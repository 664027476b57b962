"""Whatever fails, in whatever order: laws that hold at the bus."""

from collections.abc import Callable
from dataclasses import replace
from random import Random

import pytest
from sample_vessels import heavy_sheet, pool_sheet, torpedo_sheet
from vessel_rig import Rig

from auv_vessel.body.surroundings import Surroundings
from auv_vessel.control import failsafe
from auv_vessel.hosting import WireFault
from auv_vessel.sheet import Sheet

NODES = ("Sensors", "Actuators", "Movement", "Decision")
INSTRUMENTS = ("Pressure", "Attitude", "Rates", "GroundSpeed", "Fix", "Health")


def misfortunes(random: Random) -> list[Callable[[Rig], None]]:
    """Return what may happen to a vehicle, with its chances drawn."""
    node, instrument = random.choice(NODES), random.choice(INSTRUMENTS)
    number, part, lasts = random.randrange(4), random.random(), random.uniform(0.1, 4.0)

    def disturb(rig: Rig) -> None:
        now = rig.bus.now
        rig.bus.disturb(WireFault(now, now + lasts, loss=part, corruption=1.0 - part, seed=number))

    def leak(rig: Rig) -> None:
        rig.vehicle.faults.leak = True

    return [
        lambda rig: rig.bus.kill(node),
        lambda rig: rig.bus.revive(node),
        lambda rig: rig.vehicle.faults.silent.add(instrument),
        lambda rig: rig.vehicle.faults.frozen.add(instrument),
        lambda rig: rig.vehicle.faults.silent.discard(instrument),
        lambda rig: rig.vehicle.faults.dead.add(number),
        lambda rig: rig.craft.idle(),
        lambda rig: rig.craft.go_to(random.uniform(-9.0, 9.0), 0.0, random.uniform(0.0, 4.0)),
        lambda rig: rig.craft.turn(random.uniform(0.0, 360.0)),
        disturb,
        disturb,
        leak,
    ]


SEEDS = [0, 1, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(2, 40))]


@pytest.mark.parametrize("seed", SEEDS)
def test_after_an_emergency_there_is_no_thrust_and_a_vehicle_left_alone_comes_up(seed: int) -> None:
    random = Random(seed)
    makers: tuple[Callable[[], Sheet], ...] = (pool_sheet, torpedo_sheet, heavy_sheet)
    sheet = replace(makers[seed % 3](), home=(0.0, 0.0, 2.0))
    lighter = {"weight_in_water": -3.0} if sheet.drop_weight == 0.0 else {"drop_weight": 6.0}
    sheet = replace(sheet, **lighter)
    rig = Rig(sheet, Surroundings(current=(0.1, -0.1), bottom=20.0), seed)
    rig.craft.go_to(5.0, 0.0, 2.0)
    most = [each.max_thrust for each in sheet.thrusters]
    given_up: float | None = None
    for _ in range(8):
        rig.run(random.uniform(0.3, 2.0))
        random.choice(misfortunes(random))(rig)
        assert all(abs(thrust) <= limit + 1e-6 for thrust, limit in zip(rig.commands, most, strict=True))
        if given_up is None and rig.vehicle.drives[0].stopped:
            given_up = rig.bus.now
    for name in NODES:
        rig.bus.kill(name)
    rig.until(lambda: rig.afloat, 60.0, 1.0)
    if given_up is not None:
        assert rig.pushed["status"] <= given_up + failsafe.MARGIN + 0.1
    assert max(map(abs, rig.statuses)) == 0.0
