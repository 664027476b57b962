"""A kit for authors of plug-ins."""
