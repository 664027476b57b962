"""How much is planned; for constraints, which need not import the planner for it."""

MOST = 200_000
"""Actions at most that one area may take: more are taken for a mistake, and take too long to plan."""
