"""Which findings of the search may be claimed."""
