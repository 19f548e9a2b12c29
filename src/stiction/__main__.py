"""The process of a command: ``stiction``, and ``python -m stiction``."""

import atexit
import gc
import sys

# Modules make 150 000 objects that stay. Python would search them for garbage again and again, and
# once more at the end, for a fifth of a short command's time.
FIRST_SEARCH = 200_000


def main() -> None:
    """Run the command line; leave the search for garbage to those who run for long."""
    gc.set_threshold(FIRST_SEARCH)
    atexit.register(gc.freeze)  # what ends with the process is not searched

    try:
        from stiction.cli import main as run
    except KeyboardInterrupt:  # on a slow disk loading takes seconds
        print("interrupted", file=sys.stderr)
        sys.exit(130)
    run()


if __name__ == "__main__":
    main()
