"""Targets: what code and plans can be generated for underwater vehicles."""
