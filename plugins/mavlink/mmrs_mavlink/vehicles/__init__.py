"""Vehicles in the words of programs, and what they tell."""
