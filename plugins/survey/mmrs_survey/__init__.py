"""Survey tasks for MMRS: photographing, sampling, measuring, observing and approaching."""
