"""A page in the browser that shows the curves of a study as its parameters move.

`session` holds a study, `model` simulates it with effects, `numbers` judges a set. `describe` and
`sets` say what the page shows. `fit` and `save` are what it can do. `server` and `page` bring it to
the browser; `plot.js` draws, `page.js` is the rest of the page.
"""
