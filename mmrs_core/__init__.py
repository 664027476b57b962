"""Missions of mobile multi-robot systems: models in, behaviours, controllers and runs out."""
