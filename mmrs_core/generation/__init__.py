"""Code from behaviours, by templates."""
