"""Inverse modelling of pyrolysis: from measurements of a solid to the parameters of its model."""

__version__ = "0.1.0"
