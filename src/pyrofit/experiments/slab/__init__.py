"""What all kinds have whose sample is a slab under radiant heat."""
