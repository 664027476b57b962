"""Figures of a robot type from the log of one flight: readers of logs, what the flight was, and estimates."""
