"""Activation energy over conversion, without a model of the reactions (ICTAC 2011).

Vyazovkin et al. 2011, doi 10.1016/j.tca.2011.03.034: at one conversion the rate depends on the
temperature alone, so records of several heating programmes tell its activation energy.
"""
