"""The map studio for operators."""
