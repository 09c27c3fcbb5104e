"""What helps at the start: a study for one's own files, and the reference of all its keys.

`columns` recognises the columns of a file, `draft` what a study can say from them, `write` writes
it; `reference` is the page of keys.
"""
