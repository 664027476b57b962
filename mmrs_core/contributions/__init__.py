"""What plug-ins hand in: frozen descriptors, and the protocols that they name."""
