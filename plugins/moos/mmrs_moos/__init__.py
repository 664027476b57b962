"""The target moos: behaviour files for the IvP helm of MOOS-IvP."""
