"""`pyrofit doctor`: find missing files, rights and resources before a long run.

Each check is one function from a `Situation` to its findings; `report.CHECKS` lists them. Add a
function to that list to add a check.
"""
