"""Whether models and behaviours are sound: constraints, checks, verdicts."""
