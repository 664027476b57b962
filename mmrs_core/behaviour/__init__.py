"""The semantics of the Behaviour Language: programs, steps, logs, the replayer."""
