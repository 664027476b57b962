"""What is written down: steps and black boxes."""
