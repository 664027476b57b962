"""The slots that one process keeps: what their owners do with them, and what survives."""
