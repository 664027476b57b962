"""Ground vehicles for MMRS: wheels or tracks, turning radius, slopes, water and steps."""
