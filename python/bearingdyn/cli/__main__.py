"""`python -m bearingdyn.cli`."""

import sys

from bearingdyn.cli import main

if __name__ == "__main__":
    sys.exit(main())
