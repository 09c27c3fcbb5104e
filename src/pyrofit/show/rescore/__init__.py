"""Stored sets scored again under other costs, a step of its own."""
