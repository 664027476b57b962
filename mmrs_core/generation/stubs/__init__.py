"""Typed stubs of metamodels, so that editors complete and type checkers check what models hold.

pyecoregen walks the packages and fills our template. What it fills in comes from our metaclasses, which
know what a feature is called in Python and in files. pyecoregen's own ``EcoreGenerator`` knows one name
only and, while it runs, changes what every named element of pyecore answers; the class that it is built on
does not. Where pyecoregen would write a file as soon as its text is there, ours wait until all texts are,
so that a fault leaves no half of them.
"""
