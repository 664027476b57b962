"""Everything that can go wrong with a robot, what its policies say about it, and what then happened."""
