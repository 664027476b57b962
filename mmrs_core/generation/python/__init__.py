"""The target for controllers in Python: one text for all vehicles, and a driver for each sort of them."""

from mmrs_core.generation.python.driver import PythonDriver
from mmrs_core.generation.python.moves import MOVEMENTS, go_to, place_of
from mmrs_core.generation.python.target import python_target

__all__ = ["MOVEMENTS", "PythonDriver", "go_to", "place_of", "python_target"]
