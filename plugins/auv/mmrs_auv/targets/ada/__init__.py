"""The target ada: a decision centre in Ada for each underwater vehicle, on its CAN bus."""
