"""Typed stubs of metamodels, so that editors complete and type checkers check what models hold."""
