"""The description of material, sample, exposure and experiments, in words and units."""
