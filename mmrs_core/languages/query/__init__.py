"""Paths that lead to elements and values of any model."""
