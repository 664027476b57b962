"""Ways back, as scripts for the modules of a decision centre in Ada."""

from random import Random

from ada_crafts import bits

from mmrs_mavlink.program import GoTo, Hold, Local, Robot, Step, Stop, Then

GOES, HOLDS, STOPS = 1, 2, 5


def places_of(place: Local) -> list[float]:
    """Return metres north, east and down."""
    return [place.north, place.east, -place.height]


def some_place(random: Random) -> Local:
    """Return a place of few, so that ways meet and legs lie on one line."""
    north, east = (1.5 * random.randrange(-4, 5) for _ in range(2))
    return Local(north, east, -0.75 * random.randrange(4))


def some_robot(random: Random, start: Local) -> Robot:
    """Return a robot that goes from place to place, and may come back to where it began."""
    steps = []
    count = random.randint(2, 7)
    for number in range(count):
        home = number == count - 1 and random.random() < 0.6
        goes = GoTo(start if home else some_place(random), distance=random.choice([0.0, 0.0, 0.5, 2.0]))
        movement = goes if home or random.random() < 0.8 else Hold(1.0)
        steps.append(Step(str(number + 1), movement, then=Then(str(number + 2))))
    steps.append(Step(str(count + 1), Stop()))
    return Robot("naiad", "naiad.jsonl", "sub", Local(0.0, 0.0, 0.0), "1", tuple(steps))


def some_track(random: Random, robot: Robot, start: Local) -> list[tuple[str, Local]]:
    """Return the places that the robot has come to, by the moves that ended there."""
    track = [("1", start)]
    for step in robot.steps[: random.randrange(len(robot.steps))]:
        if isinstance(step.movement, GoTo) and isinstance(step.movement.at, Local):
            track.append((step.move, step.movement.at))
    return track


def lines_of(robot: Robot, track: list[tuple[str, Local]], here: Local) -> list[str]:
    """Return the script that asks for the way back."""
    lines = ["f"]
    for number, step in enumerate(robot.steps, start=1):
        goes = step.movement if isinstance(step.movement, GoTo) else GoTo(Local(0.0, 0.0, 0.0))
        kind = {GoTo: GOES, Hold: HOLDS, Stop: STOPS}[type(step.movement)]  # type: ignore[index]
        assert isinstance(goes.at, Local)
        numbers = " ".join(map(bits, [*places_of(goes.at), goes.distance]))
        lines.append(f"m {kind} {number + 1 if step.then else 0} {numbers}")
    lines += [f"a {move} {' '.join(map(bits, places_of(place)))}" for move, place in track]
    return [*lines, f"k {' '.join(map(bits, places_of(here)))}"]
