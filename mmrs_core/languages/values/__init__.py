"""How values of attributes are written as text and read back, as EMF does it: one module a kind."""
