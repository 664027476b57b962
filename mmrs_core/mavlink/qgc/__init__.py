"""The target qgc-plan: plans for QGroundControl."""
