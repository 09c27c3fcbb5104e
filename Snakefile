"""The workflow of the installed pyrofit, whose rules and code are of one version."""

import os

import pyrofit


include: os.path.join(os.path.dirname(pyrofit.__file__), "workflow", "study.smk")


# An included file has no default target.
rule all:
    input:
        EVERYTHING,
    localrule: True
