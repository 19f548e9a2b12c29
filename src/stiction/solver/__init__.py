"""The exact solver: set-valued friction at zero slip, compiled.

While sticking, the motion is known in closed form (`stick`). While slipping, the slip
velocity is written as ``p (1, w)`` in axes that follow its direction, in which the
equations stay regular at zero slip, and is integrated by collocation (`slip`, `radau`).
Take-off is then an ordinary first step from p = 0, and landing a last step whose length
is solved for, together with its stages, from p = 0 at its end. Where a landing is not
smooth, the classical pursuit curve ends it in closed form (`landing`). `loop` puts the
pieces together; `twin` is all of it again, to be read. Laws with internal state, and
set-valued laws made smooth, never stick and are integrated by `smooth`.

The method is derived in docs/method.md; docstrings cite its equations as (M1), (M2), ...
"""
