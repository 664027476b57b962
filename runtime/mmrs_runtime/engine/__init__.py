"""The engine: one scheduler that resumes the lives of robots, in simulated or real time."""
