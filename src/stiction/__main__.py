"""The process of a command: ``stiction``, and ``python -m stiction``."""

import atexit
import gc
import os
import sys

# Modules make 150 000 objects that stay. Python would search them for garbage again and again, and
# once more at the end, for a fifth of a short command's time.
FIRST_SEARCH = 200_000
# Matrices here are small. The threads that wait for large ones do so busily, at first: that takes a
# tenth of a short command's processor time, on each core but one.
THREADS_OF_BLAS = "OPENBLAS_NUM_THREADS"


def main() -> None:
    """Run the command line; leave threads and the search for garbage to those who run for long."""
    gc.set_threshold(FIRST_SEARCH)
    atexit.register(gc.freeze)  # what ends with the process is not searched
    os.environ.setdefault(THREADS_OF_BLAS, "1")

    try:
        from stiction.cli import main as run
    except KeyboardInterrupt:  # on a slow disk loading takes seconds
        print("interrupted", file=sys.stderr)
        sys.exit(130)
    run()


if __name__ == "__main__":
    main()
