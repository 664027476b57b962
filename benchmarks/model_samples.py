"""Behaviour models of any size, as text: several robots that fly, photograph and wait for each other."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random
from typing import TextIO

_HEAD = """<?xml version="1.0" encoding="UTF-8"?>
<behaviour:Behaviour xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI" \
xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:behaviour="urn:mmrs:behaviour:1.0" \
name="sample" minimumSeparation="10.0">
"""
_FOOT = "</behaviour:Behaviour>\n"
_ROBOT_ELEMENTS = 8_000
"""A robot has at most about so many elements; large models have more robots, not longer flights."""


def write_sample(path: Path, elements: int, seed: int) -> int:
    """Write a behaviour of at least that many elements and return how many it has.

    The text is what EMF and we write for the model, but for the line breaks that EMF puts into the root.
    """
    robots = max(3, -(-elements // _ROBOT_ELEMENTS))
    with path.open("w", encoding="utf-8") as stream:
        return _Sample(stream, Random(seed), robots).write(elements)


class _Sample:
    def __init__(self, stream: TextIO, random: Random, robots: int) -> None:
        self._stream = stream
        self._random = random
        self._robots = robots
        self._elements = 1
        self._targets = 0

    def write(self, elements: int) -> int:
        self._stream.write(_HEAD)
        places = self._robots  # each robot's home is the first of the targets
        for robot in range(self._robots):
            left = (elements - self._elements - places) // (self._robots - robot)
            places += self._robot(robot, places, left)
        for target in range(places):
            self._line(1, self._coordinate(target))
        self._stream.write(_FOOT)
        return self._elements

    def _line(self, depth: int, text: str, opens: bool = True) -> None:
        self._stream.write(f"{'  ' * depth}<{text}>\n")
        self._elements += opens

    def _coordinate(self, number: int) -> str:
        latitude, longitude = (self._random.uniform(a, a + 0.05) for a in (42.35, 13.35))
        altitude = self._random.choice(("20.0", "30.0", "42.5"))
        return (
            f'targets xsi:type="behaviour:GeoCoordinate" name="P{number}" latitude="{latitude!r}" '
            f'longitude="{longitude!r}" altitude="{altitude}"/'
        )

    def _robot(self, robot: int, first_place: int, elements: int) -> int:
        """Write one robot, whose moves with their places come to so many elements; return its places."""
        self._line(1, f'robots id="r{robot}" typeName="quadrotor" home="//@targets.{robot}"')
        begun, slots = self._elements, max(1, elements // 200)
        for slot in range(slots):
            self._line(2, f'slots name="s{robot}_{slot}"/')
        self._line(2, 'moves xsi:type="behaviour:Start" name="start"/')
        moves = 1
        while self._elements - begun + 2 * moves < elements:  # each has a place and a transition to come
            self._go_to(moves, first_place + moves - 1, slots)
            moves += 1
        self._line(2, 'moves xsi:type="behaviour:Stop" name="stop"/')
        for move in range(moves):
            wait = f' waitFor="{self._slot(robot, slots)}"' if self._random.random() < 0.05 else ""
            ends = " ".join(
                f'{end}="//@robots.{robot}/@moves.{move + step}"' for step, end in enumerate(("from", "to"))
            )
            self._line(2, f"moveTransitions {ends}{wait}/")
        self._line(1, "/robots", opens=False)
        return moves - 1

    def _go_to(self, move: int, place: int, slots: int) -> None:
        speed = self._random.choice(("", ' speed="0.5"', ' speed="0.75"'))
        kind = self._random.random()
        text = (
            f'moves xsi:type="behaviour:GoTo" name="m{move}" task="survey" rule="cover" '
            f'target="//@targets.{place}"{speed}'
        )
        if kind < 0.5:
            self._line(2, f"{text}/")
            return
        self._line(2, text)
        for depth, line, opens in self._actions(kind, slots):
            self._line(depth, line, opens)
        self._line(2, "/moves", opens=False)

    def _actions(self, kind: float, slots: int) -> Iterator[tuple[int, str, bool]]:
        if kind < 0.9:
            begin = 'postActions xsi:type="behaviour:DeviceAction" actionName="TakePicture" deviceId="camera"'
            if kind < 0.7:
                yield 3, f"{begin}/", True
                return
            yield 3, begin, True
            yield 4, 'parameters key="format" value="raw &amp; jpeg"/', True
            yield 3, "/postActions", False
            return
        other = self._slot(self._random.randrange(self._robots), slots)
        yield 3, f'postActions xsi:type="behaviour:UnicastNotify" slot="{other}"/', True

    def _slot(self, robot: int, slots: int) -> str:
        return f"//@robots.{robot}/@slots.{self._random.randrange(slots)}"
