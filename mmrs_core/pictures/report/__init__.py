"""Makes the page that tells people how a flight went."""
