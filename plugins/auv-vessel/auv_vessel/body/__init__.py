"""The vehicle in simulation: hull, water, thrusters and their drives, battery, sensors, devices."""
