"""Advice where the data leave something open."""
