"""The system: a mass on a plane, pulled by a spring with two stiffnesses."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property, partial
from math import pi, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import AfterValidator, model_validator
from pydantic_core import PydanticCustomError

from stiction.arguments import is_list
from stiction.drive import (
    ConstantVelocity,
    Drive,
    DriveProgram,
    LoadProgram,
    ahead,
    drive_stretches,
    load_at,
    load_stretches,
    read_drive,
    read_load,
)
from stiction.drive.pieces import DRIVE_PIECES
from stiction.drive.program import fastest_turn, nominal_velocity
from stiction.drive.recorded.reading import locator, with_rows
from stiction.errors import DescriptionError, Fault, echo
from stiction.friction import Anisotropic, Law, has_state, read_law, registered_name
from stiction.friction.user.loading import finder_for_descriptions, is_own
from stiction.friction.user.validation import WRITE, is_law, sound
from stiction.names import draw, picture, warn_renamed
from stiction.system.load_cell import CellAxis
from stiction.system.replacement import refusals
from stiction.system.springs import Springs, read_springs, whole
from stiction.system.tensors import ROUND, solver_axes, unit_vector
from stiction.system.writing import parameter_table, slider_tables
from stiction.text.sections import Section, as_html
from stiction.text.toml import Reader, folder_of, gather, read_slider, toml_text
from stiction.text.units import Angle, Damping, Force, Mass, Radians, Stiffness
from stiction.text.validation import Described, faulty, fields_to_read, in_si

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def _within_a_right_angle(phi: float) -> float:
    if abs(phi) > pi / 2 * (1 + 1e-12):
        raise ValueError(
            f"must lie between -90 deg and 90 deg, is {phi * 180 / pi:g} deg; "
            "name the axis x that lies nearer to the drive direction"
        )
    return phi


def _is_law(value: Any) -> Any:
    if isinstance(value, type) or not isinstance(value, tuple):
        raise ValueError(f"{echo(value)} is not a friction law; {_remedy_for(value)}")
    given = value.law if isinstance(value, Anisotropic) else value
    name = type(given).__name__
    try:
        is_law(type(given), name)
        law = in_si(given)
        if registered_name(law) is None:
            sound(law, name)
    except DescriptionError as error:
        if error.faults[0].path.startswith(f"{name}."):
            raise faulty(
                [each._replace(path=each.path[len(name) + 1 :]) for each in error.faults]
            ) from None
        raise ValueError(error.faults[0].message) from None
    if law is given:
        return value
    return value._replace(law=law) if isinstance(value, Anisotropic) else law


def _remedy_for(value: Any) -> str:
    """Return the remedy for an object that is not a law; for a user's own, how to write it."""
    kind = value if isinstance(value, type) else type(value)
    if isinstance(value, type) and issubclass(value, tuple):
        return f"make one with the values of its fields, {kind.__name__}(...)"
    if not (callable(value) or hasattr(kind, "coefficient") or hasattr(kind, "force")):
        return "write for example st.Coulomb(mu_0=0.2)"
    name = getattr(value, "__name__", kind.__name__)
    return WRITE.format(name=name if name.isidentifier() else "MyLaw")


def _is_drive(value: Any) -> Any:
    if not isinstance(value, ConstantVelocity | DriveProgram):
        pieces = is_list(value) or type(value) in DRIVE_PIECES.values()
        right = "st.protocols.DriveProgram(program=[...])" if pieces else CONSTANT
        raise ValueError(f"{echo(value)} is not a drive; write for example {right}")
    return value


def _is_load(value: Any) -> Any:
    if value is not None and not isinstance(value, LoadProgram):
        raise ValueError(
            f"{echo(value)} is not a program of the load; write for example "
            "st.protocols.LoadProgram(program=[st.protocols.Ramp('20 N', '1 s')])"
        )
    return value


def _are_several(springs: Any) -> bool:
    """Return whether springs are given, or values that cannot be springs."""
    return springs is not None and not (isinstance(springs, Sequence) and not springs)


FROM_SPRINGS = ("k_x", "k_y")  # follow from the springs in series, where there are several
DRIVE = "ConstantVelocity | DriveProgram"
CONSTANT = "st.ConstantVelocity('1 mm/s')"


class Apparatus(Described):
    """The mechanical part: mass, springs, dampers, misalignment, load (see `Slider`)."""

    mass: Mass
    if TYPE_CHECKING:  # a checker cannot know that springs in series replace them
        k_x: Stiffness = 0.0
        k_y: Stiffness = 0.0
    else:
        k_x: Stiffness
        k_y: Stiffness
    phi: Annotated[Angle, AfterValidator(_within_a_right_angle)]
    normal_load: Force
    c_x: Damping = 0.0
    c_y: Damping = 0.0
    mass_y: Mass | None = None
    mass_angle: Angle = Radians(0.0)
    damping_angle: Angle = Radians(0.0)
    cell_angle: Angle | None = None
    driven: Literal["plate", "spring"] = "plate"
    springs: Springs = ()

    @model_validator(mode="before")
    @classmethod
    def _make_one_spring(cls, values: Any) -> Any:
        """Fill in the stiffnesses of springs in series; their own faults come with the rest."""
        if not isinstance(values, Mapping) or not _are_several(values.get("springs")):
            return values
        try:
            along, across, _ = whole(read_springs(values["springs"]))
        except PydanticCustomError:
            along, across = 1.0, 1.0
        return {"k_x": along, "k_y": across, **values}

    @model_validator(mode="after")
    def _agree_with_springs(self) -> Self:
        """Refuse stiffnesses beside springs in series."""
        if not self.springs:
            return self
        message = "follows from springs; leave it out, or change one of them: springs.NAME.k_x"
        made = dict(zip(FROM_SPRINGS, whole(self.springs)[:2], strict=True))
        found = [Fault(name, message) for name in FROM_SPRINGS if getattr(self, name) != made[name]]
        if found:
            raise faulty(found)
        return self

    @cached_property
    def turn(self) -> float:
        """From the line that angles count from to the axis x of the springs, rad: zero, unless
        springs in series have axes of their own."""
        return whole(self.springs).angle if self.springs else 0.0

    @cached_property
    def misalignment(self) -> float:
        """From the axis x of the springs to the drive direction X, rad: `phi`, unless springs in
        series have axes of their own."""
        angle = self.phi - self.turn
        return Radians(0.0 if self.springs and abs(angle) < ROUND else angle)

    @cached_property
    def aligned(self) -> bool:
        """Whether there is one mass, and dampers lie along the springs."""
        one_mass = self.mass_y is None or self.mass_y == self.mass
        return one_mass and (self.damping_angle == self.turn or self.c_x == self.c_y)

    def own_fields(self) -> tuple[str, ...]:
        """Return the names of the fields that a description states; others follow from them."""
        names = tuple(type(self).model_fields)
        return tuple(name for name in names if not (self.springs and name in FROM_SPRINGS))


class Slider(Apparatus):
    r"""A mass in frictional contact with a plane, pulled through an anisotropic spring.

    The axes x and y are the principal axes of the spring; the drive moves along X, which
    lies at the misalignment angle phi from x (Nakano & Popov, Figs. 1 and 2). Each
    parameter is a number in SI or a string with its unit; phi needs its unit.

    Parameters
    ----------
    mass : float or str
        The mass m that slides, kg.
    k_x, k_y : float or str
        Principal stiffnesses, N/m.
    phi : str
        Misalignment angle between x and X, within 90 degrees of zero; ``slider.phi`` is in rad,
        and another slider takes it as it is.
    normal_load : float or str
        Normal load W, N; the initial value of a load program.
    friction : FrictionLaw
        For example `ExponentialWeakening` or `Coulomb`.
    drive : ConstantVelocity or DriveProgram
        The drive velocity in time.
    load : LoadProgram, optional
        The normal load in time, if it is not constant.
    c_x, c_y : float or str, optional
        Damping constants of the spring along x and y, N s/m; none in the paper.
    mass_y : float or str, optional
        The mass in motion along y, if it is another one than along x: where one stage rides on
        another, the upper moves with less. Then `mass` is that along x.
    mass_angle : str, optional
        From x, towards y, to the axis of `mass`, where masses have axes of their own.
    damping_angle : str, optional
        From x, towards y, to the axis of `c_x`, where dampers have axes of their own.
    cell_angle : str, optional
        From the drive direction X, towards Y, to the axis of the load cell; by default it is that
        of the spring, x, and the cell reads k_x u_x. All that is said of the force, ``mu`` and the
        results of friction tests among it, is of the force along the cell: in steady sliding it
        reads cos(phi) of friction; at an angle of ``"0 deg"``, along the drive, all of it.
    driven : {"plate", "spring"}, optional
        What the drive moves: the plate, with the far end of the spring fixed (Fig. 1 and
        Eq. (1)), or the far end of the spring, with the plate at rest (Fig. 2). At constant
        velocity both are equivalent. When a driven plate accelerates, friction must also carry
        the inertia m dv_d/dt; when its velocity jumps, the slip velocity jumps with it. With a
        driven spring end, neither happens.
    springs : sequence of Spring, optional
        Springs in series from the slider to the drive, in place of `k_x` and `k_y`, which follow:
        compliances add. Where they have axes of their own, all angles count from one line x of the
        apparatus, and the axes x and y of results are the principal axes of the whole, at
        ``slider.turn`` to it; ``slider.misalignment`` is theirs to the drive.

    Raises
    ------
    DescriptionError
        With every fault at once.

    Notes
    -----
    Glossary of the symbols used throughout, with the paper's equations:

    ========== ======================================================= ===== =====
    symbol     meaning                                                 unit  Eq.
    ========== ======================================================= ===== =====
    u_x, u_y   spring elongations along the principal axes             m     1
    v_x, v_y   elongation rates du_x/dt, du_y/dt                       m/s   2
    v_slip     slip speed, magnitude of drive velocity minus (v_x,v_y) m/s   3
    theta      friction angle to x, that of the slip velocity          deg   1
    psi        friction angle to X, theta - phi                        deg   1
    F          friction force; on the mass it points at theta + 180    N     1
    mu         spring force along X over W, as a test reports it       1     \-
    X, Y       position of the mass in the laboratory                  m     6
    V          drive velocity                                          m/s   2
    F_0        friction force at vanishing slip, mu_0 W                N     7
    l_x        slip length F_0/k_x                                     m     8
    omega_x    sqrt(k_x/m), the low natural frequency                  rad/s 10
    omega_y    sqrt(k_y/m), the high natural frequency                 rad/s 9
    A          mu_0 W/(2 V sin(phi) sqrt(m k_x))                       1     10
    zeta       instantaneous damping ratio A sin^3(theta)              1     10
    ========== ======================================================= ===== =====

    The spring pulls the mass along its elongation; the friction on the mass points against its
    slip over the plate: m u'' + K u = F s/\|s\|, with s the slip velocity. Results hold the
    magnitude ``friction`` and the angle ``theta`` at which s lies; on the mass the force has the
    components -F cos(theta) and -F sin(theta) along x and y, and so it is drawn in every figure.
    While the mass sticks, theta is the angle of the force that friction holds. On an
    `Anisotropic` surface the force and the slip differ in direction; theta is that of the force.

    Angles are in degrees wherever they are data: results, tables and figures, as their
    ``attrs["units"]`` say. What you write carries its unit. As numbers in Python, ``slider.phi``
    and the arguments of `stiction.theory`, they are in rad, the unit of SI.
    """

    friction: Annotated[Any, AfterValidator(_is_law), "friction law"]
    drive: Annotated[Any, AfterValidator(_is_drive), DRIVE] = ConstantVelocity(0.0)
    load: Annotated[Any, AfterValidator(_is_load), "LoadProgram | None"] = None

    @property
    def law(self) -> Law:
        """The friction law, typed."""
        law: Law = self.friction
        return law

    @property
    def motion(self) -> Drive:
        """The drive, typed; a program with one velocity only becomes that velocity."""
        drive: Drive = self.drive
        return drive.simplest() if isinstance(drive, DriveProgram) else drive

    @property
    def drive_speed(self) -> float:
        """The one speed of the drive that others vary from, in m/s; zero if there is none.

        See `stiction.drive.program.nominal_velocity`.
        """
        return abs(nominal_velocity(self.motion))

    @cached_property
    def direction(self) -> tuple[float, float]:
        """Unit vector of X in the axes (x, y), (cos phi, sin phi), exact at a right angle."""
        return unit_vector(self.misalignment)

    def along_drive(self, x: Any, y: Any) -> Any:
        """Return the component along X of a vector with these components along the axes (x, y)."""
        c, s = self.direction
        return c * x + s * y

    def along_axes(self, X: Any, Y: Any) -> tuple[Any, Any]:
        """Return the components along the axes (x, y) of a vector with these along (X, Y)."""
        c, s = self.direction
        return X * c - Y * s, X * s + Y * c

    @property
    def F_0(self) -> float:
        """Friction force at vanishing slip, mu_0 W, in N; for a law with internal state, which may
        have none at rest, at the drive's speed (that of its start, if it goes to and fro)."""
        sliding = self.drive_speed or abs(self.motion.rate(0.0)[0])
        return self.law.coefficient(sliding if has_state(self.law) else 0.0) * self.normal_load

    @property
    def loading_time(self) -> float:
        """Time in which the drive loads the spring along x by all of friction, s."""
        return self.F_0 / (self.k_x * self.drive_speed)

    @property
    def natural_frequencies(self) -> tuple[float, float]:
        """Natural frequencies of the mass on its spring, the slower first, in Hz."""
        m_x, m_y = self.masses
        low, high = sorted((self.k_x / m_x, self.k_y / m_y))
        return sqrt(low) / (2 * pi), sqrt(high) / (2 * pi)

    @property
    def stiffer_axis(self) -> int:
        """Axis of the stiffer spring, 0 for x and 1 for y."""
        return 1 if self.k_y >= self.k_x else 0

    @property
    def natural_frequency_x(self) -> float:
        """Natural frequency of the mass on the spring along x, in Hz."""
        return sqrt(self.k_x / self.masses[0]) / (2 * pi)

    @property
    def natural_frequency_y(self) -> float:
        """Natural frequency of the mass on the spring along y, in Hz."""
        return sqrt(self.k_y / self.masses[1]) / (2 * pi)

    @property
    def masses(self) -> tuple[float, float]:
        """The mass (kg) that swings on each spring, k over its natural frequency squared.

        Where the mass has axes of its own, the two swings are those of mass and springs together.
        """
        if self.aligned:
            return self.mass, self.mass
        axes = solver_axes(self)
        x, y = (float(k / axes.mass) for k in axes.stiffness)  # squares of the frequencies
        return self.k_x / x, self.k_y / y

    @cached_property
    def load_cell(self) -> CellAxis:
        """The axis of the load cell in x and y, that of the spring along x or of `cell_angle`."""
        x, y = 1.0, 0.0
        if self.cell_angle is not None:
            x, y = unit_vector(self.misalignment + self.cell_angle)
        share = float(self.along_drive(x, y))
        share = 0.0 if abs(share) < ROUND else share  # at a right angle
        velocity = nominal_velocity(self.motion)
        turned = (velocity < 0.0) != (share < 0.0)
        return CellAxis(x, y, share, velocity * share, -1.0 if turned else 1.0)

    @property
    def modulation_frequencies(self) -> tuple[float, ...]:
        """Frequencies (Hz) in the programs of drive and load.

        Of harmonics; those that the rows of a recorded table show well, with eight to a period; and
        that of the shortest pieces that alternate.
        """
        drive, load = self.drive, self.load
        parts = [*getattr(drive, "program", ()), *getattr(load, "program", ())]
        parts += [getattr(drive, name, None) for name in ("along", "across")]
        parts.append(getattr(load, "modulation", None))
        known = [part.frequency for part in parts if hasattr(part, "frequency")]
        known += [fastest_turn(each) for each in (drive, load) if hasattr(each, "program")]
        return tuple(frequency for frequency in known if frequency > 0.0)

    @property
    def shaken(self) -> tuple[float, ...]:
        """Deprecated: `modulation_frequencies`."""
        warn_renamed("Slider.shaken", "Slider.modulation_frequencies")
        return self.modulation_frequencies

    def weight(self, t: Any) -> Any:
        """Return the normal load at time `t` (float or array, s), in N."""
        return load_at(self.normal_load, self.load, t)

    def steady_until(self, t: float) -> float:
        """Return when the piece of the drive's or the load's program at time `t` (s) ends, in s.

        That of the one that ends first; infinity if neither has another piece.
        """
        drive = ahead(drive_stretches(self.motion), t)
        load = ahead(load_stretches(self.normal_load, self.load), t)
        return min(drive[0], load[0])

    def plot(self, ax: Any = None) -> Axes:
        """Draw the slider from above; see `stiction.plotting.plot_slider`."""
        drawn: Axes = draw("plot_slider", self, ax)
        return drawn

    def replace(self, **changes: Any) -> Self:
        """Return the same slider with some parameters changed, e.g. ``phi="3 deg"``."""
        known = type(self).model_fields
        if found := refusals(self, changes, known):
            try:  # all faults at once
                self.replace(**{name: changes[name] for name in changes if name in known})
            except DescriptionError as error:
                found += error.faults
            raise DescriptionError(found)
        values = fields_to_read(self, self.own_fields())
        if _are_several(changes.get("springs")):
            values = {name: each for name, each in values.items() if name not in FROM_SPRINGS}
        return type(self)(**(values | changes))

    @classmethod
    def from_toml(
        cls,
        path: str | Path,
        changes: Mapping[str, Any] | None = None,
        *,
        trust: bool = False,
    ) -> Slider:
        """Read only the slider of a description; `Description` reads all of it.

        Parameters
        ----------
        path : str or Path
            A file, or a text of several lines as `to_toml` writes it.
        changes : mapping, optional
            Other values of some parameters by their paths, as `Description.from_toml`.
        trust : bool, optional
            Whether the files of a friction law and of recorded tables may lie outside the
            description's folder.
        """
        folder = folder_of(path)
        find = finder_for_descriptions(folder, trust)
        read, strange = read_slider(path, changes)
        raw, lost = with_rows(read, locator(folder, trust))
        return cls.from_parts(
            gather(
                raw,
                {**SLIDER_TABLES, "friction": partial(read_law, find=find)},
                absent=OPTIONAL_TABLES,
                last=("friction",) if is_own(raw.get("friction")) else (),
                known=[*strange, *lost],
            )
        )

    def _repr_html_(self) -> str:
        table = as_html([Section("Slider", [], parameter_table(slider_tables(self)))])
        return table + picture("plot_slider", self)

    def to_toml(self) -> str:
        """Return the slider as TOML with units, which `from_toml` reads back.

        A user's friction law is named by its file and class.

        Examples
        --------
        >>> import stiction as st
        >>> print(st.presets.nakano_popov_2020().to_toml())
        [slider]
        mass = "250 g"
        k_x = "1 kN/m"
        k_y = "10 MN/m"
        phi = "1 deg"
        normal_load = "10 N"
        <BLANKLINE>
        [friction]
        law = "exponential-weakening"
        mu_0 = 0.2
        mu_inf = 0.15
        v_f = "10 mm/s"
        <BLANKLINE>
        [drive]
        velocity = "1 mm/s"
        <BLANKLINE>
        """
        return toml_text(slider_tables(self))

    @classmethod
    def from_parts(cls, parts: Mapping[str, Any]) -> Slider:
        """Make a slider from the parts that the readers in `SLIDER_TABLES` returned."""
        apparatus: Apparatus = parts["slider"]
        return cls(
            **apparatus.model_dump(mode="json", include={*apparatus.own_fields()}),
            friction=parts["friction"],
            drive=parts["drive"],
            load=parts.get("load"),
        )


def slider_of(source: Any) -> Slider:
    """Return the slider that is given, or the one of a description, a run or a file.

    Raises
    ------
    DescriptionError
        If `source` is none of these.
    """
    if isinstance(source, Slider):  # at once: a root finder asks for the same slider many times
        return source
    found = getattr(source, "slider", source)
    return found if isinstance(found, Slider) else Slider.from_toml(source)


SLIDER_TABLES: dict[str, Reader] = {
    "slider": lambda table: Apparatus(**table),
    "friction": read_law,
    "drive": read_drive,
    "load": read_load,
}
OPTIONAL_TABLES = ("load",)
