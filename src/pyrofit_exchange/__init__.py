"""Exchange with other programs: the parts of a study that they can express, and their files."""

from pathlib import Path

RULES = Path(__file__).with_name("fds.smk")
"""Rules of the workflow that write files for FDS and run it."""
