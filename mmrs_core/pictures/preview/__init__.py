"""Pictures of missions: map, timeline and altitude profile."""
