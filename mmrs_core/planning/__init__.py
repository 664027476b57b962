"""Who does what, when, and by which way: pure algorithms over scenes."""
