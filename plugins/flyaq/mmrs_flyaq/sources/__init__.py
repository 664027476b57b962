"""What source files say: elements, values and references of any language, and the classes these are of."""
