"""Would the tests notice an error? One place of the code is changed at a time, and they must fail.

``python -m benchmarks.mutation`` draws places in the sources at random, changes each by an operator
of Cosmic Ray, and runs the tests that reach it, with the solver as plain Python, until one fails. A
mutant for which none fails has survived: it does the same as the code (then it is listed in
`equivalent.toml`, with the reason), or a test is missing.
"""

import os

# before any library is imported: no compiling, and no threads, which a forked process would lack
for name in ("NUMBA_DISABLE_JIT", "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS"):
    os.environ[name] = "1"
os.environ["PYTEST_DISABLE_PLUGIN_AUTOLOAD"] = "1"
