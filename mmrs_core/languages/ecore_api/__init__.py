"""Metamodels and models as pyecore's own API knows them."""
