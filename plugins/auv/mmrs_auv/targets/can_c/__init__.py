"""The target can-c: the drives of thrusters, as firmware in C."""
