"""A second, independent solver of the same equations, slow and plain.

It verifies the kernels and makes synthetic measurements. It shares nothing with them but the
description in words and the effects of the apparatus on finished curves. It has other unknowns:
temperatures at nodes, and the extent of every reaction in the elements between them. Its
discretisation also differs, in space (finite elements) and time (backward differences).
"""
