"""`pyrofit doctor`: find before hours are spent what a study lacks.

Each check is one function from a `Situation` to its findings; `report.CHECKS` lists them. Add a
function to that list to add a check.
"""
