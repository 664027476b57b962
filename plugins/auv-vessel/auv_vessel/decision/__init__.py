"""The decision centre: what a vehicle does, one thing after another, and what stops it."""
