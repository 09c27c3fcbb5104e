"""Which reaction scheme thermogravimetric records support, a step of its own."""
