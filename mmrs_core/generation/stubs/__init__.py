"""Typed stubs of metamodels, so that editors complete and type checkers check what models hold.

They are made of this package's metaclasses, which know what a feature is called in Python and in files.
pyecoregen could drive the same template, but knows only one name: while it runs, it changes what every
named element of pyecore answers. It also writes its files as it goes, so that a fault leaves half of them.
"""
