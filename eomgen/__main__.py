"""`python -m eomgen`: the command line."""

from eomgen.cli import main

if __name__ == "__main__":
    main()
