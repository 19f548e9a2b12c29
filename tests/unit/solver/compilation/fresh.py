"""What one kernel of the smooth solver finds, to the last bit: of code just compiled, or loaded.

It is small enough to compile in a few seconds, and has parts within parts.
"""

from math import inf

import numpy as np
from tests.drawn import inside

import stiction as st
from stiction.solver.accuracy import Accuracy
from stiction.solver.compilation import jit
from stiction.solver.compilation.machine_code import Shelf
from stiction.solver.problem import Isotropic
from stiction.solver.segments import segments
from stiction.solver.smooth.dispatch import point_to_smooth_law
from stiction.solver.smooth.error_estimate import local_error
from stiction.solver.smooth.right_hand_side import SmoothOutset
from stiction.solver.smooth.workspace import Workspace

SIZES = [
    (6, 4),
    (6, 4),
    (6, 4, 4),
    4,
    4,
    (4, 4),
    (2, 4),
    (4, 4, 9),
    (4, 4),
    (4, 3),
    (6, 6),
    (3, 6, 6),
]
HELD = Accuracy(1e-6, 1e-12, 1e-4, 0.1, 0.02, inf, 2e-3, 2.5e-4, 6e-6, 0.0, 0.0, 1e-12)
BRISTLES = st.laws.LuGre(0.15, 0.2, "10 mm/s", 1e5, 300.0, 2.0)


def error_of(problem, start, h, w, accuracy):
    """Return the error of a step."""
    return local_error(problem, start, h, w, accuracy)


def main():
    """Print how often the code was loaded, and all numbers in hexadecimal."""
    compiled = jit._entry(error_of, Shelf(error_of))
    slider = st.presets.nakano_popov_2020().replace(friction=BRISTLES)
    problem = next(segments(slider, 0.3, 1.3)).problem
    problem = problem._replace(law=point_to_smooth_law(BRISTLES), surface=Isotropic())
    start, numbers = SmoothOutset(0.35, 2e-3, -3e-5, inf, 1e-3, 1.0), []
    for h, row in zip(np.geomspace(1e-6, 1e-2, 40), inside(40, *[(-1e-3, 1e-3)] * 24), strict=True):
        w = Workspace(*map(np.zeros, SIZES))
        w.values.flat[:] = row
        w.values[:, 2:] *= 1e-3
        w.size[:] = 1e-5
        numbers += [compiled(problem, start, h, w, HELD), *w.error, *w.values.flat]
    print(sum(compiled.stats.cache_hits.values()), *(float(x).hex() for x in numbers))


if __name__ == "__main__":
    main()
