"""Shared parts of all kinds whose sample is a slab under radiant heat."""
