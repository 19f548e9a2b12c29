"""The solver for set-valued friction, exact at zero slip.

While sticking, the motion is known in closed form. While slipping, the slip velocity is written as
``p (1, w)`` in axes that follow its direction (`slip_frame`), in which the equations stay regular
at zero slip, and is integrated by collocation (`collocation`, `newton`) over the transverse
oscillation, which is known (`oscillation`). Take-off is then an ordinary first step from p = 0, and
landing a last step whose length is solved for, together with its stages, from p = 0 at its end.
Where a landing is not smooth, the classical pursuit curve ends it in closed form (`pursuit`). A
`step` is guessed (`predictor`), solved and judged (`error_estimate`); `loop` puts steps together.
"""
