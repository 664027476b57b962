"""Flights of autopilots' own simulations: what is flown, what happens meanwhile, and how it must end.

`table` lists them, as values of `flight`; `flying` flies one and `judging` measures it;
`benchmarks/real_flights.py` prints them.
"""
