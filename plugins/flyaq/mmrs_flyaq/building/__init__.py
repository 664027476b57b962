"""From the elements of a source to elements of our languages."""
