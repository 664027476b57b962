"""Execution of behaviours by interpretation."""
