"""What carries messages between processes, and what of it reaches other machines."""
