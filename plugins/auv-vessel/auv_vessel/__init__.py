"""The control and mission layers of an underwater vehicle, standalone: no MMRS.

They need numpy, python-can and cantools.

``sheet.py`` says what a vehicle is made of, ``wire/`` what is said on its CAN bus and how, ``body/`` is
the vehicle in simulation, ``control/`` reads sensors and drives thrusters, ``movement/`` brings the
vehicle to its goal. Every part is a `node.Node`: it receives frames, and sends some when its time
has come, whether that time is real or simulated.

Body axes are x forward, y starboard, z down; places are metres north and east of the mission's origin
and metres below the water surface; headings are degrees clockwise from north.
"""
