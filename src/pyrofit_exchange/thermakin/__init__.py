"""ThermaKin2Ds: components, and conditions of slabs and heating rates."""
