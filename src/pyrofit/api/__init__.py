"""The Python interface: the names of `import pyrofit as pf`, in memory and in the study's units.

Data flow: `studies` reads a study, `drafting` makes one. `measurements` reads its series,
`simulation` and `comparison` set curves beside them, `fitting` and `searching` find parameters,
`diagnosing` finds missing effects. `results` loads a finished campaign. Each calls the functions
that the steps of the workflow call. `report`, `tables` and `plots` show the results.
"""
