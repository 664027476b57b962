"""Whether robots that wait for each other can get stuck."""
