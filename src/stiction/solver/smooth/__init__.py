"""The solver for friction that is a smooth function of slip velocity, load and internal state.

The unknowns of a step are a slip coordinate (`coordinate`) and the internal states at the
three stages of Radau IIA (`newton`); the derivatives of a law are taken by differences
(`rates`), so that it need not give any. A filtered defect measures a step's error, and the
same filter makes what lies inside a step as exact as its end (`inside`, `sampling`). `loop`
puts the pieces together, `law` makes a set-valued law smooth.
"""
