"""What logs and black boxes tell of a flight: for the replay, the preview and the report."""
