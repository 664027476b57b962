"""Example (a), the mission of the paper, flown on any vehicles in either way, and judged.

`mission` plans and judges it, `fleets` are the vehicles, `ways` fly it.
"""
