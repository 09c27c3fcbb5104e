"""Gpyro: input files of slabs and heating rates."""
