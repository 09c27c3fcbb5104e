"""Subjects of the report, a folder each; a folder defines ``PAGE``, its files their items."""
