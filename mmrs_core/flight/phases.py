"""What robots are at, as whoever asks is told."""

WAITS = "waits for its vehicle"
WORKS = "works"
SUSPENDED = "waits for its battery"
LOST = "has ended by a lost link"
ENDED = "has ended"
