"""A plug-in of pytest, with which hypothesis draws no constants out of the modules that happen to be loaded.

Workers load different ones, so that one seed would try other examples in each run; and to look for constants
in all of them takes a process ten seconds.
"""


def pytest_configure() -> None:
    from hypothesis.internal.conjecture import providers

    providers._get_local_constants = lambda: providers._local_constants
