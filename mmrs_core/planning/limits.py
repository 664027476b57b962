"""How much is planned; for constraints, which need not import the planner for it."""

MOST = 200_000
"""Actions at most that one area may take: more, nobody means, and nobody waits for their planning."""
