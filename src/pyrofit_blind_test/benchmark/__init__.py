"""The benchmark of hidden effects: data sets for everybody, a scorer, and simple baselines."""
