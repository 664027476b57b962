"""MAVLink's services: commands, missions, parameters."""
