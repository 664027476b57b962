"""Mapping files: what becomes of each class and feature of a dialect."""
