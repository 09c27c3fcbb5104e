"""Measured series: fetched by checksum, read with their units, checked, and in SI from here on."""
