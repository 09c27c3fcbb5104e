"""The shown half: a folder for each subject with its tables, figures and sentences."""
