"""External programs as simulators: template, run, output, and what is kept of every run."""
