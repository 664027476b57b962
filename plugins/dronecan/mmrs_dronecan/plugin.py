"""Contributes nothing: `--drives` names the drives to the actuator controller.

Metadata of installations from before name this module as a plug-in, until they are renewed.
"""
