"""The apparatus from above as it moves: the picture of a film.

The frame of reference is that of the spring's far end. X, the drive direction, points to the right,
the axes x and y of the spring lie at -phi to it. Elongations are magnified, each axis by a round
factor, which the picture states.
"""

from __future__ import annotations

from math import cos, floor, log10, sin

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch, Polygon

from stiction.arrays import Floats
from stiction.friction import ellipse
from stiction.friction.law import limit_coefficient
from stiction.plotting.apparatus.shapes import dashpot_paths, spring_path
from stiction.plotting.page.style import (
    BLACK,
    BLUE,
    FLOOR,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    RED,
)  # fmt: skip
from stiction.plotting.run.time_series import DEEPEST
from stiction.result.table import ColumnTable
from stiction.system.slider import Slider
from stiction.system.tensors import dampers_askew
from stiction.text.quantity.wording import in_words

ROOM = (7.2, 4.2)  # of the picture: its unit is the side of the mass
BEHIND = {"facecolor": FLOOR, "edgecolor": "none", "alpha": 0.8, "pad": 1.0}  # words
HOME = np.array([0.3, -0.45])  # of the mass, where the springs are relaxed
WALLS = np.array([3.1, 2.2])  # along x and y from there, where the picture has this room
MARGINS = np.array([[0.2, 0.2], [0.2, 0.4]])  # right and above, left and below: words
DAMPER = 1.45  # length of one with an axis of its own
LARGEST_DISPLACEMENT = np.array([1.2, 0.5])  # displacement of the mass in the picture
RADIUS = 1.35  # of the largest friction force
SIDE = 0.42  # half of the mass
GRID = 0.9  # between the marks on the plate
DECADES = 4.0  # of the slip speed, over which its arrow grows
INCH = 0.0254


class Scene:
    """Artists that show the state of a run at any time, on given axes."""

    def __init__(self, ax: Axes, slider: Slider, samples: ColumnTable) -> None:
        """Draw the fixed parts, and create the moving ones."""
        self.slider, self.samples = slider, samples
        c, s = slider.direction
        self.turn = np.array([[c, s], [-s, c]])  # from x, y to X, Y
        self.dampers = [self.turn @ away(angle) for angle in dampers_askew(slider).values()]
        self.walls = [wall_distance(self.turn[:, axis], far) for axis, far in enumerate(WALLS)]
        self.scale = magnification(samples)
        friction, load = samples["friction"], samples["normal_load"]
        self.limit = limit_coefficient(slider.law, friction, load)
        largest = self.limit * max(ellipse(slider.law)[0], 1.0) * float(np.max(load))
        self.newton = RADIUS / (max(largest, float(np.nanmax(friction))) or 1.0)
        self.fastest = float(np.nanmax(samples["slip_speed"]))
        self.slowest = slowest_slip(samples)
        self._prepare(ax, samples)
        self._draw_walls(ax)
        self.artists = self._make(ax)

    def _prepare(self, ax: Axes, samples: ColumnTable) -> None:
        half_x, half_y = ROOM[0] / 2, ROOM[1] / 2
        ax.set(xlim=(-half_x, half_x), ylim=(-half_y, half_y), aspect="equal")
        ax.set_xticks([])
        ax.set_yticks([])
        ax.set_facecolor(FLOOR)
        pixel = INCH * ax.get_window_extent().width / ax.figure.get_dpi() / ROOM[0]
        words = magnification_in_words(self.scale * pixel, samples)
        drive = ("$X$, drive", BLUE, -half_x + 1.0, "left")
        legend = (drive, (words, GREY, half_x - 0.1, "right"))
        self.legend = [  # over the plate, whose marks would part its numbers
            ax.text(x, -half_y + 0.14, text, ha=side, fontsize=9, color=color, bbox=BEHIND)
            for text, color, x, side in legend
        ]
        ax.annotate(
            "",
            (-half_x + 0.9, -half_y + 0.2),
            (-half_x + 0.2, -half_y + 0.2),
            arrowprops={"arrowstyle": "-|>", "color": BLUE},
        )

    def _draw_walls(self, ax: Axes) -> None:
        for axis, across in ((0, 1), (1, 0)):
            along, side = np.eye(2)[axis], np.eye(2)[across]
            reach = 0.45 + LARGEST_DISPLACEMENT[across]
            far = self.walls[axis] * along
            ends = [HOME + self.turn @ (far + r * side) for r in (-reach, 0.45)]
            ax.plot(*np.transpose(ends), color=GREY, linewidth=4, solid_capstyle="butt")
        for way in self.dampers:
            normal = 0.22 * np.array([-way[1], way[0]])
            ends = [HOME + DAMPER * way + normal, HOME + DAMPER * way - normal]
            ax.plot(*np.transpose(ends), color=GREY, linewidth=4, solid_capstyle="butt")
        corners = HOME + SIDE * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1)])
        ax.plot(*corners.T, color=GREY, linewidth=0.8, linestyle=":")

    def _make(self, ax: Axes) -> list[Artist]:
        (self.marks,) = ax.plot([], [], ".", color="#CFCABB", markersize=4, zorder=1)
        (self.spring_x,) = ax.plot([], [], color=RED, linewidth=1.5, zorder=3)
        (self.spring_y,) = ax.plot([], [], color=ORANGE, linewidth=2.5, zorder=3)
        (self.circle,) = ax.plot([], [], color=PURPLE, linewidth=1.0, zorder=2)
        self.pistons = [
            [ax.plot([], [], color=BLACK, linewidth=1.0, zorder=3)[0] for _ in range(3)]
            for _ in self.dampers
        ]
        self.block = Polygon(np.zeros((4, 2)), facecolor="#C9CCD0", edgecolor=BLACK, zorder=4)
        ax.add_patch(self.block)
        self.force, self.slip = (
            FancyArrowPatch(
                (0, 0), (1, 0), arrowstyle="-|>", mutation_scale=14, linewidth=width, color=color,
                shrinkA=0, shrinkB=0, zorder=5,
            )
            for color, width in ((PURPLE, 2.5), (GREEN, 2.0))
        )  # fmt: skip
        for arrow in (self.force, self.slip):
            ax.add_patch(arrow)
        left, top = -ROOM[0] / 2 + 0.15, ROOM[1] / 2 - 0.3
        self.words = [
            ax.text(left, top - 0.28 * i, "", fontsize=10, color=color, zorder=6, bbox=BEHIND)
            for i, color in enumerate((BLACK, GREEN, PURPLE, RED))
        ]
        dampers = (line for parts in self.pistons for line in parts)
        springs = (self.spring_x, self.spring_y)
        moving = (self.marks, *self.legend, self.circle, *springs, *dampers, self.block)
        return [*moving, self.force, self.slip, *self.words]

    def show(self, state: dict[str, float], words: str) -> None:
        """Move everything to a state: the run's columns at a time; `words` state the time."""
        u = np.array([state["u_x"], state["u_y"]])
        mass = HOME - self.turn @ (self.scale * u)
        self._move_plate(state)
        self._move_springs(mass)
        corners = SIDE * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        self.block.set_xy(mass + corners @ self.turn.T)
        at_rest = state["sticking"] > 0.5 or state["slip_speed"] < self.slowest
        self.block.set_facecolor("#6B6F75" if at_rest else "#C9CCD0")
        outline, tip = self._forces(state)
        self.circle.set_data(*(mass + outline).T)
        self.force.set_positions(tuple(mass), tuple(mass + tip))
        self.slip.set_positions(tuple(mass), tuple(mass + self._slip(state)))
        self.slip.set_visible(not at_rest)
        lines = (
            words,
            f"slip speed: {'at rest' if at_rest else in_words(state['slip_speed'], 'm/s', 3)}",
            f"friction: {in_words(state['friction'], 'N', 3)} at ψ = {state['psi']:.1f}°",
            f"spring force $k_x u_x$: {in_words(state['spring_x'], 'N', 3)}",
        )
        for each, text in zip(self.words, lines, strict=True):
            each.set_text(text)

    def _move_plate(self, state: dict[str, float]) -> None:
        u = np.array([state["u_x"], state["u_y"]])
        travel = state["X"] + (self.turn @ u)[0]
        half_x, half_y = ROOM[0] / 2, ROOM[1] / 2
        shift = (-self.scale[0] * travel) % GRID
        x, y = np.meshgrid(
            np.arange(-half_x + shift, half_x, GRID), np.arange(-half_y, half_y, GRID)
        )
        self.marks.set_data(x.ravel(), y.ravel() + 0.2)

    def _move_springs(self, mass: Floats) -> None:
        away = self.turn.T @ (mass - HOME)
        for axis, line, turns in ((0, self.spring_x, 7), (1, self.spring_y, 6)):
            side = 1 - axis
            unit = np.eye(2)
            start = mass + self.turn @ (SIDE * unit[axis])
            end = HOME + self.turn @ (self.walls[axis] * unit[axis] + away[side] * unit[side])
            line.set_data(*spring_path(start, end, 0.16, turns).T)
        for way, parts in zip(self.dampers, self.pistons, strict=True):
            paths = dashpot_paths(mass, HOME + DAMPER * way, 0.16)
            for line, path in zip(parts, paths, strict=True):
                line.set_data(*path.T)

    def _forces(self, state: dict[str, float]) -> tuple[Floats, Floats]:
        """Return the outline of the friction limit and the tip of the force, from the mass."""
        ratio, angle = ellipse(self.slider.law)
        around = np.linspace(0.0, 2.0 * np.pi, 73)
        axes = np.column_stack([np.cos(around), ratio * np.sin(around)])
        c, s = cos(angle), sin(angle)
        outline = self.limit * state["normal_load"] * axes @ np.array([[c, s], [-s, c]])
        psi = np.radians(np.nan_to_num(state["psi"]))
        tip = -state["friction"] * np.array([np.cos(psi), np.sin(psi)])
        return self.newton * outline, self.newton * tip

    def _slip(self, state: dict[str, float]) -> Floats:
        """Return the arrow of the slip velocity: its length is logarithmic."""
        speed = state["slip_speed"]
        if not speed > 0.0:
            return np.array([0.0, 0.0])
        size = np.log10(speed / self.fastest) / DECADES + 1.0
        length = SIDE + 1.1 * min(max(size, 0.0), 1.0)
        way = self.turn @ np.array([state["slip_x"], state["slip_y"]]) / speed
        found: Floats = length * way
        return found


def away(angle: float) -> Floats:
    """Return the unit vector of an axis at an angle (rad) to x, away from the springs."""
    way = np.array([cos(angle), sin(angle)])
    return -way if way.sum() > 0.0 else way


def magnification(samples: ColumnTable) -> Floats:
    """Return the factors of elongations (per metre) along x and y; nearly equal ones are one."""
    largest = np.array([np.nanmax(np.abs(samples[name])) for name in ("u_x", "u_y")])
    found = LARGEST_DISPLACEMENT / np.where(largest > 0.0, largest, largest.max() or 1.0)
    found = np.array([10.0 ** floor(log10(x)) * floor(x / 10.0 ** floor(log10(x))) for x in found])
    return np.full(2, found.min()) if found.max() < 12.0 * found.min() else found


def magnification_in_words(factors: Floats, samples: ColumnTable) -> str:
    """Return by how much elongations along x and y are magnified; an axis at rest is not."""
    moved = [bool(np.nanmax(np.abs(samples[name])) > 0.0) for name in ("u_x", "u_y")]
    if all(moved) and factors[0] == factors[1]:
        return rf"elongations $\times$ {factor_in_words(factors[0])}"
    words = [
        rf"${name} \times$ {factor_in_words(each)}"
        for name, each in zip(("u_x", "u_y"), factors, strict=True)
    ]
    return (
        ",  ".join(each for each, moves in zip(words, moved, strict=True) if moves)
        or "nothing moves"
    )


def factor_in_words(factor: float) -> str:
    """Return a magnification to two digits, as the page of the explorer writes it.

    >>> [factor_in_words(each) for each in (0.000842, 3.1, 1234.0, 2.5e6)]
    ['0.00084', '3.1', '1,200', '2.5 million']
    """
    if factor >= 1e6:
        return f"{factor_in_words(factor / 1e6)} million"
    rounded = float(f"{factor:.2g}")
    return (
        f"{rounded:,.{max(1 - floor(log10(rounded)), 0)}f}".rstrip("0").rstrip(".")
        if rounded < 10.0
        else f"{rounded:,.0f}"
    )


def slowest_slip(samples: ColumnTable) -> float:
    """Return the slip speed below which the mass is shown at rest, m/s."""
    return DEEPEST * float(np.nanmax(np.hypot(samples["drive_X"], samples["drive_Y"])))


def wall_distance(way: Floats, most: float) -> float:
    """Return how far a wall is from the home of the mass along a unit vector, within the picture.

    A spring that is turned far would leave it.
    """
    back = way < 0.0
    room = 0.5 * np.array(ROOM) - np.where(back, MARGINS[1] - HOME, MARGINS[0] + HOME)
    return float(min(most, *(room / np.maximum(np.abs(way), 1e-9))))
