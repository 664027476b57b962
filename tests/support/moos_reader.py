"""Reads behaviour files of MOOS-IvP and carries them out: written from its manual, apart from the target.

A file holds lines ``initialize VAR = value`` and blocks ``Behavior = TYPE { name = value … }``; what follows
``//`` is a comment. A behaviour runs while all its conditions hold and it is not complete; what is complete
posts its end flags, once. Variables that nobody has posted meet no condition.
"""

import re
from math import dist

KNOWN = {
    "BHV_Waypoint": {"points", "speed", "capture_radius", "slip_radius", "repeat"},
    "BHV_ConstantDepth": {"depth", "duration"},
    "BHV_StationKeep": {"station_pt", "center_activate", "inner_radius", "outer_radius", "outer_speed"},
    "BHV_Timer": {"duration", "duration_idle_decay"},
}
COMMON = {"name", "pwt", "condition", "endflag"}
SEVERAL = {"condition", "endflag"}
CONDITION = re.compile(r"([A-Za-z_][A-Za-z0-9_]*) *(=|<=|>=) *(.+)")


def read(text):
    """Return the variables at first, and the behaviours: each a type, and lists of values by parameter."""
    variables, behaviours, block = {}, [], None
    for line in (each.partition("//")[0].strip() for each in text.split("\n")):
        if not line:
            continue
        assert line.isascii()
        if block is None and line.startswith("initialize "):
            name, equals, value = line.removeprefix("initialize ").partition("=")
            assert equals
            variables[name.strip()] = value.strip()
        elif block is None and re.fullmatch(r"Behavior *= *BHV_\w+", line):
            block = (line.partition("=")[2].strip(), None)
        elif block is not None and block[1] is None:
            assert line == "{", line
            block = (block[0], {})
        elif line == "}":
            behaviours.append(_checked(*block))
            block = None
        else:
            name, equals, value = line.partition("=")
            assert block is not None, line
            assert equals, line
            block[1].setdefault(name.strip(), []).append(value.strip())
    assert block is None
    names = [each["name"][0] for _, each in behaviours]
    assert len(set(names)) == len(names)
    return variables, behaviours


def _checked(kind, parameters):
    assert set(parameters) <= KNOWN[kind] | COMMON, (kind, parameters)
    for name, values in parameters.items():
        assert name in SEVERAL or len(values) == 1, (kind, name)
    for condition in parameters["condition"]:
        assert CONDITION.fullmatch(condition), condition
    return kind, parameters


class Helm:
    """A vehicle whose helm goes by a behaviour file: what it passes, and what was posted."""

    def __init__(self, text, place=(0.0, 0.0), dive_rate=0.5):
        self.variables, self.behaviours = read(text)
        self.place, self.depth, self.dive_rate = place, 0.0, dive_rate
        self.ran, self.complete = {}, set()
        self.posted, self.passed = [], [(*place, 0.0)]
        self.time = 0.0

    def post(self, name, value):
        self.posted.append((self.time, name, value))
        self.variables[name] = value

    def step(self, seconds=0.25):
        """Let some time pass; return the messages to other communities."""
        self.variables["NAV_DEPTH"] = str(self.depth)
        self.time += seconds
        running = [each for each in self.behaviours if self._runs(each)]
        goals = [p for kind, p in running if kind in ("BHV_Waypoint", "BHV_StationKeep")]
        assert len(goals) <= 1, "two behaviours pull into two directions"
        depths = [float(p["depth"][0]) for kind, p in running if kind == "BHV_ConstantDepth"]
        assert len(depths) <= 1, "two behaviours want two depths"
        for depth in depths:
            change = max(-self.dive_rate * seconds, min(self.dive_rate * seconds, depth - self.depth))
            self.depth += change
        for _, each in running:
            if "points" in each:
                self._go(each, seconds)
        self.passed.append((*self.place, self.depth))
        before = len(self.posted)
        for kind, each in running:
            name = each["name"][0]
            self.ran[name] = self.ran.get(name, 0.0) + seconds
            if kind == "BHV_Timer" and self.ran[name] >= float(each["duration"][0]):
                self._end(each)
        return [value for _, name, value in self.posted[before:] if name == "NODE_MESSAGE_LOCAL"]

    def _runs(self, behaviour):
        _, each = behaviour
        return each["name"][0] not in self.complete and all(map(self._holds, each["condition"]))

    def _holds(self, condition):
        name, sign, wanted = CONDITION.fullmatch(condition).groups()
        found = self.variables.get(name)
        if found is None:
            return False
        if sign == "=":
            return found == wanted
        return float(found) <= float(wanted) if sign == "<=" else float(found) >= float(wanted)

    def _go(self, each, seconds):
        goal = tuple(map(float, each["points"][0].split(",")))
        way, reach = dist(self.place, goal), float(each["speed"][0]) * seconds
        part = min(1.0, reach / way) if way else 1.0
        self.place = tuple(a + part * (b - a) for a, b in zip(self.place, goal, strict=True))
        if dist(self.place, goal) <= float(each["capture_radius"][0]):
            self.place = goal  # as if it had gone on to the middle: what is measured are the plan's places
            self._end(each)

    def _end(self, each):
        self.complete.add(each["name"][0])
        for flag in each.get("endflag", []):
            name, _, value = flag.partition("=")
            self.post(name.strip(), value.strip())


def run(helms, seconds=4_000.0, answers=()):
    """Run helms by community's name until all are done; carry their messages; post what is answered."""
    for helm in helms.values():
        helm.post("DEPLOY", "true")
        for name, value in answers:
            helm.post(name, value)
    while any(helm.variables["MMRS_DONE"] != "true" for helm in helms.values()):
        for name, helm in helms.items():
            for message in helm.step():
                said = dict(pair.split("=") for pair in message.split(","))
                assert said["src_node"] == name
                helms[said["dest_node"]].post(said["var_name"], said["string_val"])
        if max(helm.time for helm in helms.values()) > seconds:
            return False
    return True
