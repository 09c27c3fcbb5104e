"""Run the command line by ``python -m pyrofit``, as the rules of the workflow do."""

import sys

from pyrofit.cli import main

if __name__ == "__main__":
    sys.exit(main())
