"""The blind test of the diagnosis, on twins: synthetic measurements with hidden effects.

A hidden effect is one that the twin's truth has and the fitted model lacks. The diagnosis reads
only the measurements and a study without the truth; its claims are then compared with the truth.
"""
