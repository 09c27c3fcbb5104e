"""External programs as simulators: template, run, output, and the record of every run."""
