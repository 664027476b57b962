"""Missions, behaviours and flights as drawings of map programs, layer by layer."""
