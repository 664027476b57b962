"""Figures of a robot type from the logs of flights: readers of logs, what the flight was, and estimates."""
