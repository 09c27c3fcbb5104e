"""Free corrections of the model: terms that no effect of the catalogue needs to have."""
