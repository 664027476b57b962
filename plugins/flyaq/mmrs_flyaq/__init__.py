"""Models of other dialects turned into ours by a mapping file, with a report of what is not as it was."""
