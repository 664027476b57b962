"""Pictures of missions for people: the place, the ways, the heights, and who waits for whom."""
