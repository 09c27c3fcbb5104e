"""What all kinds have whose sample follows a temperature programme."""
