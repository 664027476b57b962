"""From models to a scene: everything in one local metric frame, without a model behind it."""
