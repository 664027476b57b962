"""A kit for authors of plug-ins; most of it needs pytest and hypothesis.

``conformance`` holds the laws for each sort of contribution, as test classes. ``instances`` draws random
models of any metamodel, ``values`` the values of attributes. ``scenes``, ``models`` and ``programs`` make
samples by hand, and ``vehicle`` is a vehicle for generated controllers to talk to.
"""
