"""The control layer: reads sensors, drives thrusters, and fails safe."""
