"""Movement primitives: closed loops that bring the vehicle to where it is to be and keep it there."""
