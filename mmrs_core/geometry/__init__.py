"""Pure geometry over arrays, in metres: frames, polygons, distances, clearance."""
