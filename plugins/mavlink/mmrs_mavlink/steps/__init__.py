"""Programs carried out, step by step, and what may end them."""
