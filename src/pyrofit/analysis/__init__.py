"""Facts about results, computed once: best sets, tests, errors, recovery of a known truth."""
