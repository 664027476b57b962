"""Drives one robot over its link: a thread waits for the vehicle, and the engine never does."""
