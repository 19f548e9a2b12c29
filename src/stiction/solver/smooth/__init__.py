"""The solver for friction that is a smooth function of slip velocity, load and internal state.

The unknowns of a step are a slip coordinate (`coordinate`) and the internal states at the
three stages of Radau IIA (`newton`). A law may give its derivatives; otherwise they are
differences (`dispatch`). A filtered defect estimates the error of a step, and the same filter
makes values inside a step as exact as its end (`error_estimate`, `sampling`).
"""
