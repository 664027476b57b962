"""What generated controllers of underwater vehicles carry beside the runtime: vehicles on CAN buses."""
