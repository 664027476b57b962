"""Versions of languages: models of older ones on their way into newer, and what differs between two."""
