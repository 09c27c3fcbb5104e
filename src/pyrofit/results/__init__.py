"""Results of a study: their files, and what each must hold where it is read again."""
