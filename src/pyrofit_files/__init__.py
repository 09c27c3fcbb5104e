"""Identification of each measured file of a folder, and its findings."""
