"""The target mavlink-python: standalone controllers on top of pymavlink."""
