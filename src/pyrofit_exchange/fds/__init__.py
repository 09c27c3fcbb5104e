"""Fire Dynamics Simulator: input files of a fitted material, runs that check them, import."""
