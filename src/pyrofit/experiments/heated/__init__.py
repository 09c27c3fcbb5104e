"""Shared parts of all kinds whose sample follows a temperature programme."""
