"""Underwater vehicles as plain data, for tests of what goes over their buses."""

from math import cos, pi, sin

from hypothesis import strategies as st

from auv_vessel.sheet import Sheet, Thruster


class Asked(dict):
    """Values of a sheet that remember which of them somebody asked for."""

    def __init__(self) -> None:
        super().__init__()
        self.keys_asked: set[str] = set()

    def get(self, key, default=None):
        self.keys_asked.add(key)
        return super().get(key, default)


def thruster(number: int, **changes: object) -> Thruster:
    """Return a thruster of a row, each pushing in another direction."""
    figures = {
        "id": f"T{number + 1}",
        "position": (0.3 * cos(number), 0.3 * sin(number), 0.0),
        "direction": (cos(number), sin(number), 0.0),
        "operating_thrust": 40.0,
        "max_thrust": 50.0,
        "operating_power": 300.0,
        "max_power": 400.0,
        "max_depth": 100.0,
    }
    return Thruster(**(figures | changes))  # type: ignore[arg-type]


def sheet(count: int = 6, **changes: object) -> Sheet:
    """Return a vehicle with that many thrusters."""
    figures = {
        "robot": "sub1",
        "thrusters": tuple(thruster(number) for number in range(count)),
        "length": 0.8,
        "width": 0.5,
        "height": 0.4,
        "mass": 35.0,
        "weight_in_water": -0.5,
        "speed": 1.5,
        "max_depth": 50.0,
        "battery": 2e6,
        "home": (1.0, -2.0, 0.0),
        "devices": ("torpedo", "gripper"),
    }
    return Sheet(**(figures | changes))  # type: ignore[arg-type]


@st.composite
def sheets(draw: st.DrawFn) -> Sheet:
    """Draw a vehicle that a bus can be made of."""
    count = draw(st.sampled_from([0, 1, 2, 4, 6, 8, 32]))
    ids = draw(st.lists(_NAMES, min_size=count, max_size=count, unique=True))
    rows = []
    for number, id in enumerate(ids):
        most = draw(st.floats(0.01, 32767.0))
        angle = draw(st.floats(-pi, pi))
        rows.append(
            thruster(
                number,
                id=id,
                direction=(cos(angle), 0.0, sin(angle)),
                operating_thrust=max(0.01, most * draw(st.floats(0.1, 1.0))),
                max_thrust=most,
                max_power=draw(st.floats(0.0, 6553.5)),
            )
        )
    return sheet(
        0, thrusters=tuple(rows), bit_rate=draw(st.sampled_from([125_000, 250_000, 500_000, 1_000_000]))
    )


_NAMES = st.text(
    st.characters(exclude_categories=["C", "Z"], exclude_characters='"\\'), min_size=1, max_size=20
)
