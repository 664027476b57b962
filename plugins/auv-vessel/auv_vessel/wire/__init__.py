"""What is said on the CAN bus of a vehicle, and how it gets from one process to another."""
