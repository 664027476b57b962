"""Versions of languages: migration of older models, and the differences of two versions."""
