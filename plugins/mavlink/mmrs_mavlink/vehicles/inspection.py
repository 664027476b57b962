"""Whether the devices of a vehicle can do what its program asks of them: inspected before it takes off.

Parameters show whether a command has an effect, and a camera describes itself; whether anything is connected
to an output is known only where an action was tried.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import dataclass, field

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_runtime.faults import RefusedError, UnansweredError

from ..links.link import Link
from ..links.messages import ANYBODY
from ..profiles.needs import OF_CAMERAS, ROI_LOCATION, Judgement
from ..program import GoTo, Measure, Operate, Robot, Turn
from ..services import parameters
from ..services.commands import command, name_of
from .vehicle import Vehicle

UNDESCRIBED = (
    "whether its camera is connected, or set up since the vehicle was last started: none describes itself"
    " (CAMERA_INFORMATION)"
)
VALUE_SECONDS = 3.0
"""Within which a value that a device publishes regularly has come."""


@dataclass(slots=True)
class Findings:
    """What was found.

    Attributes:
        defects: why the program cannot be carried out, each with its culprit first.
        lines: what operators should know, what is unknown included.
    """

    defects: list[str] = field(default_factory=list)
    lines: list[str] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class _Use:
    """A command of a program to a device, or to a gimbal that looks somewhere."""

    device: str
    action: str
    command: int
    params: tuple[float, ...]
    operate: Operate | None = None

    def is_tried(self, devices: Collection[str]) -> bool:
        """Return whether its action is carried out before take-off, given the devices to be tried."""
        return self.operate is not None and (self.operate.trial or self.device in devices)

    @property
    def shown(self) -> str:
        """Return the device with its action, as printed."""
        action = f" ({self.action})" if self.action else ""
        return f"device '{self.device}'{action}" if self.operate is not None else self.device


def inspect_devices(link: Link, vehicle: Vehicle, robot: Robot, tried: Collection[str] = ()) -> Findings:
    """Return whether all devices that a program uses can do so, as far as is known before take-off.

    Args:
        link: to the vehicle, which stands on the ground.
        vehicle: of the robot.
        robot: its program.
        tried: devices whose actions are carried out now, beside those whose actions may always be tried.
    """
    found, uses = Findings(), tuple(dict.fromkeys(_uses(robot)))
    needs = {
        use: link.profile.autopilot.needs[use.command](use.params)
        for use in uses
        if use.command in link.profile.autopilot.needs
    }
    names = dict.fromkeys(name for need in needs.values() for name in need.all_names)
    values = parameters.read(link, names) if names else {}
    described = _described(link) if any(use.command in OF_CAMERAS for use in uses) else ()
    seen: set[tuple[str, Judgement]] = set()
    trials: dict[Operate, str] = {}
    for use in uses:
        judgement = needs[use].judge(values) if use in needs else Judgement()
        if (use.shown, judgement) in seen:
            continue
        seen.add((use.shown, judgement))
        why = "" if judgement.defect else _trial(vehicle, use, tried, trials)
        if judgement.defect or why:
            found.defects.append(f"{use.shown}: {judgement.defect or why}")
        else:
            found.lines.append(_line(use, judgement, described, works=use.is_tried(tried)))
    found.lines += _unpublished(link, robot)
    unused = sorted(set(tried) - {use.device for use in uses if use.operate is not None})
    found.lines += [f"device '{each}': not tried: the program does not operate it" for each in unused]
    return found


def _line(use: _Use, judgement: Judgement, described: tuple[str, ...], *, works: bool) -> str:
    """Return what is known of a device without a defect, and what is not."""
    known, unknown = [*judgement.met], [judgement.unknown]
    if use.command in OF_CAMERAS:
        known += described
        unknown += [] if described else [UNDESCRIBED]
    if not (judgement.met or judgement.unknown or works):
        unknown.append(f"no parameter shows whether {name_of(use.command)} has an effect")
    if works:
        known.append("works: it was tried")
    else:
        unknown.append("whether it works: it was not tried")
    parts = (", ".join(known), f"unknown: {', '.join(filter(None, unknown))}" if any(unknown) else "")
    return f"{use.shown}: {'; '.join(filter(None, parts))}"


def _trial(vehicle: Vehicle, use: _Use, tried: Collection[str], trials: dict[Operate, str]) -> str:
    """Carry an action out, once for all of its commands, if it is to be tried; return why it has failed."""
    if use.operate is None or not use.is_tried(tried):
        return ""
    if use.operate not in trials:
        trials[use.operate] = _tried(vehicle, use.operate)
    why = trials[use.operate]
    return f"tried on the ground: {why}" if why else ""


def _tried(vehicle: Vehicle, action: Operate) -> str:
    """Carry an action out; return why it has failed; empty: it has not."""
    try:
        vehicle.operate(action.command, action.params, confirmed=action.confirmed)
        for number, params in action.more:
            vehicle.operate(number, params)
    except RefusedError as error:
        return str(error)
    return ""


def _uses(robot: Robot) -> Iterator[_Use]:
    for step in robot.steps:
        for action in (*step.before, *step.after):
            if isinstance(action, Operate):
                first = (action.command, action.params)
                yield from (
                    _Use(action.device, action.action, number, params, action)
                    for number, params in (first, *action.more)
                )
        look = step.movement.look if isinstance(step.movement, GoTo | Turn) else None
        if look is not None and look.gimbal:
            named = f"gimbal {look.device}" if look.device else "gimbal"
            yield _Use(named, "", ROI_LOCATION, (float(look.device),))


def _described(link: Link) -> tuple[str, ...]:
    """Return how the cameras of a vehicle describe themselves; empty where none does."""
    with link.inbox("CAMERA_INFORMATION", component=ANYBODY) as inbox:
        try:
            command(link, mavlink.MAV_CMD_REQUEST_MESSAGE, mavlink.MAVLINK_MSG_ID_CAMERA_INFORMATION, tries=2)
            link.wait(lambda: bool(inbox), link.patience)
        except (RefusedError, UnansweredError):
            return ()
        names = (
            " ".join(filter(None, (_text(each.vendor_name), _text(each.model_name)))) for each in tuple(inbox)
        )
        return tuple(dict.fromkeys(f"{name or 'a camera'} describes itself" for name in names))


def _text(characters: object) -> str:
    """Return the text in the bytes of a message, up to its first zero."""
    codes = bytes(int(each) for each in characters) if isinstance(characters, list | tuple) else b""
    return codes.split(b"\0")[0].decode("ascii", "replace").strip()


def _unpublished(link: Link, robot: Robot) -> Iterator[str]:
    """Yield which values a program measures that do not come."""
    actions = (each for step in robot.steps for each in (*step.before, *step.after))
    wanted = {each.value: each.device for each in actions if isinstance(each, Measure)}
    if not wanted:
        return
    with link.inbox("NAMED_VALUE_FLOAT") as inbox:
        link.wait(
            lambda: wanted.keys() <= {each.name for each in tuple(inbox)}, link.clock.patience(VALUE_SECONDS)
        )
        come = {each.name for each in tuple(inbox)}
    for value, device in wanted.items():
        if value in come:
            yield f"device '{device}': publishes {value}"
        else:
            yield f"unknown: device '{device}': has published no {value} within {VALUE_SECONDS:g} s"
