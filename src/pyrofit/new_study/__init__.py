"""`pyrofit init`: a study written from a user's own files.

`columns` recognises the columns of a file, `draft` derives what a study can state from them,
`write` writes the study.
"""
