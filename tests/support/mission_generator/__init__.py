"""Random missions for tests: seeded, and where possible solvable by construction."""
