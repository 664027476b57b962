"""Orders of people to running robots."""
