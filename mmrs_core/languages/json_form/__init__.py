"""Models as JSON: the form that docs/json.md describes, read and written."""


def is_json(file: str) -> bool:
    """Return whether a file is one of JSON, by the ending of its name."""
    return file.lower().endswith(".json")
