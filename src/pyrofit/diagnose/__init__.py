"""Diagnosis: where model and measurement disagree, and which effect the model lacks."""
