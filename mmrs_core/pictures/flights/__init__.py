"""What logs and black boxes contain of a flight: for the replay, the preview and the report."""
