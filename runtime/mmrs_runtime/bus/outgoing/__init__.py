"""What one process has to tell others, until all have answered: notifies, and news of its robots."""
