"""How attribute values are written as text and read back, as EMF does it."""
