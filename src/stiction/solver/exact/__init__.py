"""The solver for set-valued friction, exact at zero slip.

During stick, the motion is known in closed form. During slip, the slip velocity is ``p (1, w)`` in
axes that follow its direction (`slip_frame`), in which the equations are regular at zero slip. It
is integrated by collocation (`collocation`, `newton`), superposed on the transverse oscillation,
which is known in closed form (`oscillation`). Take-off is an ordinary first step from p = 0;
landing is a last step with p = 0 at its end, whose length is solved for together with its stages.
Where a landing is not smooth, the classical pursuit curve ends it in closed form (`pursuit`). A
`step` predicts (`predictor`), solves, and estimates the error (`error_estimate`); `loop` joins the
steps.
"""
