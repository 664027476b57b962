"""What goes wrong with a vehicle."""

from pymavlink.dialects.v20 import ardupilotmega as mavlink

from mmrs_mavlink.sitl import SimulatedVehicle

PHOTO = 2000


def cut_link(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("link-down")


def mend_link(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.end("link-down")


def fall_dumb(vehicle: SimulatedVehicle) -> None:
    vehicle.radio.mute = True


def speak(vehicle: SimulatedVehicle) -> None:
    vehicle.radio.mute = False


def stick(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("stick", "loiter")


def by_hand(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("stick", "altitude_hold")


def battery(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("battery", 0.15)


def stick_and_battery(vehicle: SimulatedVehicle) -> None:
    battery(vehicle)
    stick(vehicle)


def barely(vehicle: SimulatedVehicle) -> None:
    """Leave a little more than the reserve, but not what the return path takes beside it."""
    vehicle.faults.begin("battery", 0.215)


def critical(vehicle: SimulatedVehicle) -> None:
    """Have a vehicle that cannot measure its battery say all the same that it is nearly empty."""
    said = mavlink.MAVLink_battery_status_message(
        0, 0, 0, 32_767, [65_535] * 10, -1, -1, -1, -1, 0, mavlink.MAV_BATTERY_CHARGE_STATE_CRITICAL
    )
    with vehicle.lock:
        vehicle.radio.send(said)


def mute_camera(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("silent", PHOTO)


def satellites(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("gps-lost")


def shift(vehicle: SimulatedVehicle) -> None:
    """Have it take itself to be 40 m north-east of where it is."""
    vehicle.faults.begin("position-shift", 40.0, 45.0)


def obstacle(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("obstacle", 2.0)


def breach(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("breach")


def reboot(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("restart")


def motor(vehicle: SimulatedVehicle) -> None:
    vehicle.faults.begin("motor-failed")


def vehicle_clock(vehicle: SimulatedVehicle) -> None:
    vehicle.autopilot.clock_error += 3600.0
