"""How elements are referred to in files, within one and across several."""
