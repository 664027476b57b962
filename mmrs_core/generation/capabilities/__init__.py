"""What each target can express: tables that are made by trying, element by element."""
