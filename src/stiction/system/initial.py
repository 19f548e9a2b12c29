"""The initial state of a run."""

from __future__ import annotations

from math import hypot
from typing import Self

from pydantic import Field, model_validator

from stiction.errors import DescriptionError, Fault
from stiction.friction import has_state, states
from stiction.system.slider import Slider
from stiction.text.units import Length, Number, Time, Velocity
from stiction.text.validation import Described, unknown_name


class Initial(Described):
    """The initial state of a run: by default the paper's.

    Parameters
    ----------
    epsilon : float, optional
        The paper's X'(0) = epsilon V, Y'(0) = 0 (caption of Fig. 3); 1e-6 by default.
    u_x, u_y : float or str, optional
        Spring elongations, m.
    v_x, v_y : float or str, optional
        Elongation rates, m/s; both, in place of epsilon, or neither.
    states : mapping, optional
        All internal states of the friction law by name, in SI; by default those of the law's
        method ``settled``.
    time : float or str, optional
        The time at which the run starts, s; the drive moves from t = 0 on.

    Examples
    --------
    >>> import stiction as st
    >>> st.Initial(u_x="1 mm").u_x
    0.001
    """

    epsilon: Number = 1e-6
    u_x: Length = 0.0
    u_y: Length = 0.0
    v_x: Velocity | None = None
    v_y: Velocity | None = None
    states: dict[str, Number] | None = None
    time: Time = Field(default=0.0, ge=0)

    @model_validator(mode="after")
    def _one_way_to_say_it(self) -> Self:
        if (self.v_x is None) != (self.v_y is None):
            raise ValueError("v_x and v_y go together; give both, or epsilon alone")
        if self.v_x is not None and "epsilon" in self.model_fields_set:
            raise ValueError("epsilon and v_x, v_y say the same thing twice; give one of them")
        return self

    def internal(self, slider: Slider) -> tuple[float, ...]:
        """Return the internal states of the slider's law at the start.

        Raises
        ------
        DescriptionError
            If the given states are not those of the law.
        """
        law = slider.law
        names = [state.name for state in states(law)]
        given = self.states
        if given is not None:
            found = [
                Fault(f"initial.states.{name}", unknown_name("internal state", name, names))
                if names
                else Fault(f"initial.states.{name}", "the friction law has no internal state")
                for name in given
                if name not in names
            ]
            found += [
                Fault(f"initial.states.{name}", "missing; give all internal states, or none")
                for name in names
                if name not in given
            ]
            if found:
                raise DescriptionError(found)
            return tuple(given[name] for name in names)
        if not has_state(law):
            return ()
        X, Y = slider.motion.rate(self.time)
        return tuple(float(value) for value in law.settled(float(hypot(X, Y))))

    def slip(self, slider: Slider) -> tuple[float, float]:
        """Return the slip velocity (x, y) at the start, in m/s."""
        rates = slider.motion.rate(self.time)
        if self.v_x is not None and self.v_y is not None:
            d_x, d_y = slider.along_axes(*rates)
            return d_x - self.v_x, d_y - self.v_y
        # the slip velocity is that of the mass over the floor: X' along X
        (c, s), X = slider.direction, self.epsilon * rates[0]
        return X * c, X * s
