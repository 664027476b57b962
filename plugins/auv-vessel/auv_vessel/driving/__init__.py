"""A vehicle on its CAN bus as the engine drives it, whatever its program is written in.

`vehicle` carries orders out; `orders` is what it must know of a program; `connected` is one on a real bus.
"""
