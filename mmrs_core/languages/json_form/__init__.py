"""Models as JSON: the form that docs/json.md describes, read and written."""
