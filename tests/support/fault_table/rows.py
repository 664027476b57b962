"""The fault table: every fault of one vehicle, with at least two policies each."""

from fault_table import strikes
from fault_table.events import event_rows, landing_rows, own_failsafe_rows
from fault_table.links import link_rows
from fault_table.pilots import pilot_rows
from fault_table.row import LEG, Row, policy
from fault_table.waits import device_rows, wait_rows

ROWS: tuple[Row, ...] = (
    *link_rows(),
    *pilot_rows(),
    *event_rows(),
    *own_failsafe_rows(),
    *landing_rows(),
    *device_rows(),
    *wait_rows(),
    Row(
        "vehicle's clock jumps",
        LEG,
        policy("VEHICLE_RESTARTED", "LAND"),
        strikes.vehicle_clock,
        "",
        "done",
        within=None,
        stay=5.0,
    ),
)
