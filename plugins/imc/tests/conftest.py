from marine_programs import dive, does, given, swimmer

__all__ = ["dive", "does", "given", "swimmer"]
