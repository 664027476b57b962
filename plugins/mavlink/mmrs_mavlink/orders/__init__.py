"""How a vehicle obeys the orders of people."""
