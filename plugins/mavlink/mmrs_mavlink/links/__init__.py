"""Links: from ports to vehicles, signed or not."""
