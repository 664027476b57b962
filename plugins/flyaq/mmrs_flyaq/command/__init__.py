"""The command ``mmrs migrate``."""
