"""Predictions of a finished study against tests that it did not fit, and against other people's.

`given` reads the tests, `others` the predictions of others, `score` compares, `compute` does all of
it, and `page` writes table, page and figures.
"""
