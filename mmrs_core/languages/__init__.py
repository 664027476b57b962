"""The modelling languages in memory: metamodels, model elements, reading, writing and conformance."""
