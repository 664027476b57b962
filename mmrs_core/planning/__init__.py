"""Plans: which robot does what, when and along which route. Pure algorithms over scenes."""
