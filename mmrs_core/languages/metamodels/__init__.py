"""Metamodels: read, taken apart and put together as classes, and handed on to other tools."""
