"""What is drawn on maps in other programs, and the formats in which they keep it."""
