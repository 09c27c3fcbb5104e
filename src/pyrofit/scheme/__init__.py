"""Which reaction scheme the thermogravimetric records of a study support."""
