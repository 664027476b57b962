"""Times of recorded flights, and those that the same models are planned, and checked, to take."""
