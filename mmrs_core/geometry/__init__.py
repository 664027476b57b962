"""Pure geometry: frames, polygons, clearance, segments."""
