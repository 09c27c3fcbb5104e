"""`pyrofit init`: a study written from a user's own files.

`columns` recognises the columns of a file, `draft` derives the content of a study from them,
`write` writes the study.
"""
