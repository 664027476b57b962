"""The target can-python: standalone controllers of underwater vehicles on CAN buses."""
