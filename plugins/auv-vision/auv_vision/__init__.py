"""The eyes of a vehicle: stereo pictures, and what is seen in them, where."""
