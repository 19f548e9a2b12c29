"""The explorer's page in a real browser: Debian's Chromium, driven by Playwright."""

import json
import math
import random
import re
from itertools import pairwise

import numpy as np
import pytest
from tests.explored import an_opened, serving
from tests.waiting import PATIENCE, until

import stiction as st
from stiction.explorer import answers
from stiction.explorer.answers import tables_of
from stiction.explorer.form import form
from stiction.explorer.source import open_sources
from stiction.media.scene import factor_in_words
from stiction.result.peak import largest_spring_force
from stiction.text.quantity.exact import quantity_text

SIZE = {"width": 1280, "height": 720}
SHOWN = "Boolean(window.stictionPage?.shown) && !stictionPage.shown.quick"


class Page:
    """A page of the explorer, and what the browser said of it."""

    def __init__(self, tab, explorer):
        self.tab, self.explorer = tab, explorer
        self.said, self.asked = [], []
        tab.on("console", lambda message: self.said.append(f"{message.type}: {message.text}"))
        tab.on("pageerror", lambda error: self.said.append(str(error)))
        tab.on("request", lambda request: self.asked.append(request.url))
        tab.on("websocket", lambda socket: self.asked.append(socket.url))

    def visit(self, state):
        self.tab.goto(self.explorer.address + state)
        self.until(SHOWN)
        self.settle()

    def value(self, expression):
        return self.tab.evaluate(expression)

    def until(self, expression):
        """Wait for something to be so, inside the page, at no cost to this process.

        The driver does that by `eval`, which the page's own policy forbids.
        """
        so = self.value(
            f"""new Promise((done, fail) => {{
            const end = performance.now() + {1e3 * PATIENCE};
            const look = () => {{
              try {{
                if ({expression}) done(true);
                else if (performance.now() > end) done(false);
                else setTimeout(look, 10);
              }} catch (error) {{ fail(error); }}
            }};
            look(); }})"""
        )
        assert so, f"{expression} hangs"

    def done_after(self, act):
        """Do something, and wait until what it asks for is shown, with every peak."""
        before = self.value("stictionPage.asked")
        act()
        self.until(f"{SHOWN} && stictionPage.shown.asked > {before}")

    def settle(self):
        """Wait until all that was asked for, also by a change of the layout, has been drawn."""
        frames = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
        self.value(frames)  # in which a change of the layout is noticed
        self.until("stictionPage.settled")
        self.value(frames)

    def drawn_picture(self, canvas):
        self.settle()
        return self.picture(canvas)

    def number(self, name):
        return float(self.value(f"document.querySelector('[data-name=\"{name}\"]').dataset.value"))

    def picture(self, canvas):
        return self.value(f"document.querySelector('{canvas}').toDataURL()")

    def row(self, path):
        return self.tab.locator(f'[data-path="{path}"]')


@pytest.fixture(scope="module")
def explorer():
    """Its maps of stability have few cells: each state of the page has a map of its own."""
    with pytest.MonkeyPatch.context() as patch, serving(an_opened(duration=0.25)) as made:
        patch.setattr(answers, "LEVELS", ((6, 6), (12, 12)))
        yield made


@pytest.fixture(scope="module")
def opened(browser, explorer):
    tab = browser.new_page(viewport=SIZE)
    tab.set_default_timeout(PATIENCE * 1e3)
    return Page(tab, explorer)


@pytest.fixture
def tab(opened, explorer):
    """The page as the last test left it; whatever a test does to it, it does in silence."""
    opened.said, opened.asked = [], []
    yield opened
    opened.tab.emulate_media(color_scheme="light")
    assert opened.said == []  # no error, no warning, in any of these tests
    away = [
        url for url in opened.asked if f"//127.0.0.1:{explorer.port}/{explorer.token}/" not in url
    ]
    assert [url for url in away if not url.startswith(("blob:", "data:"))] == []


@pytest.fixture
def page(tab):
    """The page as it opens; a tab of its own for each test would take as long as the page.

    An address without a state is loaded, whatever was there; by way of an empty page that would
    take a new process of the browser, and nearly twice as long.
    """
    tab.tab.set_viewport_size(SIZE)
    tab.value("window.old = true")
    tab.visit("")
    assert tab.value("window.old") is None
    return tab


@pytest.fixture
def modules(tab):
    """The page in any state, for what only calls functions of its modules."""
    if not tab.tab.url.startswith("http"):
        tab.visit("")
    return tab


def test_numbers_are_those_of_simulate(page):
    page.tab.click("#panel-b [data-view=numbers]")
    run = st.simulate(an_opened().description.slider, 0.25)
    assert page.number("largest k_x u_x") == largest_spring_force(run.samples, run.slider.k_x).force
    assert page.number("stick intervals") == run.sticks.sizes["stick"]
    assert page.number("time at rest") == run.statistics.time_stuck
    assert page.number("u_x at the end") == float(run.final["u_x"])


def test_a_slider_moves_the_curves_and_can_be_undone(page):
    page.tab.click("#panel-b [data-view=numbers]")
    before, picture = page.number("u_x at the end"), page.picture("#series-still")
    slider = page.row("drive.velocity").locator("input[type=range]")
    page.done_after(lambda: slider.press("PageUp"))
    velocity = page.row("drive.velocity").locator("input[type=text]").input_value()
    assert velocity != "1 mm/s"
    wanted = st.simulate(
        an_opened().description.slider.replace(drive=st.ConstantVelocity(velocity)), 0.25
    )
    assert page.number("u_x at the end") == float(wanted.final["u_x"])
    assert page.picture("#series-still") != picture
    page.done_after(lambda: page.tab.keyboard.press("Control+z"))
    assert page.number("u_x at the end") == before
    page.done_after(lambda: page.tab.click("#redo"))
    page.done_after(lambda: page.tab.click("#reset"))
    assert page.number("u_x at the end") == before


def test_the_ends_of_each_slider_are_values_that_are_taken(page):
    """Scales were made before the server's values had come, for 0: Home gave -1000 kg."""
    paths = (
        "[...document.querySelectorAll('[data-slider]')].filter((each) => each.checkVisibility())"
    )
    page.done_after(lambda: page.tab.select_option("#law", "stribeck"))
    page.tab.click("#panel-a [data-view=numbers]")  # no map for each of the values
    found = page.value(f"{paths}.map((each) => each.dataset.slider)")
    assert "slider.mass" in found
    assert "friction.v_s" in found
    for path in found:
        slider = page.row(path).locator("input[type=range]")
        text = page.row(path).locator("input[type=text]")
        first = text.input_value()
        for end in ("Home", "End"):
            page.done_after(lambda slider=slider, end=end: slider.press(end))
            assert page.row(path).locator(".fault").inner_text() == "", (path, end)
        text.fill(first)
        page.done_after(lambda text=text: text.press("Enter"))
    slider = page.row("slider.mass").locator("input[type=range]")
    page.done_after(lambda: slider.press("Home"))
    assert page.row("slider.mass").locator("input[type=text]").input_value() == "1 g"


def test_scales_of_sliders_keep_to_the_bounds_of_the_schema(modules):
    """Also where a parameter has no value yet, or 0."""
    made, known = form(), []
    for part in (made["tables"], made["laws"], made["pieces"]["drive"], made["pieces"]["load"]):
        for each in part.values():
            known += each.get("fields", []) if isinstance(each, dict) else each
    known = [each for each in known if each["kind"] == "number"]
    assert len(known) > 90
    ends = modules.value(
        module(
            "scale.js",
            """({ scaleOf }) => FIELDS.map((field) => [0, 2e-3, 1, 3e4].map((base) => {
          const scale = scaleOf(field, base);
          return [scale.value(0), scale.value(1000), scale.place(base)];
        }))""".replace("FIELDS", json.dumps(known)),
        )
    )
    for field, scales in zip(known, ends, strict=True):
        low, high = field.get("low", -math.inf), field.get("high", math.inf)
        for first, last, place in scales:
            assert low <= first < last <= high * (1 + 1e-9), field
            assert field.get("low_allowed", True) or first > low, field
            assert math.isfinite(place), field


def test_on_paper_pictures_keep_their_proportions(modules):
    """Circles were ellipses, and what is pressed was white on white."""
    modules.tab.emulate_media(media="print")
    style = modules.value(
        "(({ objectFit, printColorAdjust }) => [objectFit, printColorAdjust])"
        "(getComputedStyle(document.querySelector('#scene')))"
    )
    modules.tab.emulate_media(media="screen")
    assert style == ["contain", "exact"]


def test_on_a_phone_the_far_end_of_the_transverse_spring_is_seen(page):
    """It lay behind the words, which hid half of the spring and its name."""
    page.tab.set_viewport_size({"width": 390, "height": 844})
    page.settle()
    grey = page.value(
        """(() => {
        const canvas = document.querySelector("#scene"), upper = Math.round(0.4 * canvas.height);
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, upper);
        let found = 0;
        for (let i = 0; i < data.length; i += 4)
          found += data.slice(i, i + 3).every((each) => each === 110);
        return found; })()"""
    )
    assert grey > 4 * 60  # px: 5 wide, and as long as the mass at least, less its edges


def test_an_axis_has_two_numbers_at_least(modules):
    """Of 56 to 64.4 degrees a low frame showed 60 alone, which tells no scale."""
    rng = random.Random(5)
    ranges = [(rng.uniform(-99, 99), 10 ** rng.uniform(-3, 3)) for _ in range(500)]
    shown = modules.value(
        module(
            "quantity.js",
            f"({{ ticks }}) => {json.dumps([[56.0, 8.4], *ranges])}"
            ".map(([low, span]) => ticks(low, low + span, 2.6).length)",
        )
    )
    assert min(shown) >= 2
    assert max(shown) <= 6


def test_numbers_at_neighbouring_ticks_do_not_overlap(modules):
    """One at the edge of a frame is moved into it, where that of the next tick may stand."""
    levels = modules.value(
        module(
            "drawing.js",
            """({ frame, contextOf }) => {
          const context = contextOf(document.createElement("canvas")), found = [];
          context.fillText = (words, x, y) => found.push(y);
          const ticks = [0, 1, 2, 3, 4, 5, 6].map((value) => [value, `${value}`]);
          const axis = { place: (value) => value / 6, ticks };
          frame(context, { left: 40, top: 0, width: 50, height: 60 }, { ...axis, ticks: [] }, axis);
          return found;
        }""",
        )
    )
    assert len(levels) == 5  # of seven: those at both edges give way to their neighbours
    assert all(one - two >= 9 for one, two in pairwise(levels))


def test_the_form_stays_under_the_hand(page):
    """The slider of what was not set yet was replaced by the first movement, and the focus lost."""

    def open_all():
        page.value("document.querySelectorAll('details').forEach((more) => (more.open = true))")

    open_all()
    page.row("slider.c_x").scroll_into_view_if_needed()
    box = page.row("slider.c_x").locator("input[type=range]").bounding_box()
    level = box["y"] + 0.5 * box["height"]
    page.tab.mouse.move(box["x"] + 8, level)
    page.tab.mouse.down()
    asked = page.value("stictionPage.asked")
    for share in (0.1, 0.8):
        page.tab.mouse.move(box["x"] + 8 + share * (box["width"] - 16), level)
        page.until(f"{SHOWN} && stictionPage.shown.asked > {asked}")
        asked = page.value("stictionPage.asked")
    page.tab.mouse.up()
    assert page.row("slider.c_x").locator("input[type=text]").input_value() == "63.1 N s/m"
    page.tab.focus("#field-slider-c_y")
    page.tab.keyboard.type("3 N s/m")
    page.done_after(lambda: page.tab.keyboard.press("Tab"))
    focus = "document.activeElement.id"
    assert page.value(focus) == "field-slider-c_y-slider"
    page.tab.focus("#drive-add")
    page.done_after(lambda: page.tab.keyboard.press("Enter"))
    assert page.value(focus) == "drive-add"
    page.tab.focus("#drive-0-away")
    page.done_after(lambda: page.tab.keyboard.press("Enter"))
    assert page.value(focus) == "drive-protocol"


@pytest.mark.parametrize("menu", ["preset", "export", "law", "drive-protocol"])
def test_menus_act_on_a_choice_and_not_on_an_arrow_key(modules, menu):
    """Each arrow key on a closed menu loaded the first preset, or opened the first export."""
    page = modules
    page.tab.focus(f"#{menu}")
    before = page.value("[stictionPage.asked, stictionPage.link.count]")
    page.tab.keyboard.press("ArrowDown")
    page.until(f"document.querySelector('#{menu}').matches(':open')")
    page.tab.keyboard.press("Escape")
    page.until(f"!document.querySelector('#{menu}').matches(':open')")
    assert page.value("[stictionPage.asked, stictionPage.link.count]") == before
    assert page.value("document.activeElement.id") == menu


def test_dampers_with_axes_of_their_own_are_drawn(page):
    """They are weak, so that the picture at the start changes by nothing else."""

    def picture_with(path, value):
        page.value("document.querySelectorAll('details').forEach((more) => (more.open = true))")
        field = page.row(path).locator("input[type=text]")
        field.fill(value)
        page.done_after(lambda: field.press("Enter"))
        return page.drawn_picture("#scene")

    along = picture_with("slider.c_x", "1e-9 N s/m")
    assert picture_with("slider.damping_angle", "40 deg") != along
    assert picture_with("slider.c_y", "1e-9 N s/m") == along  # equal ones have no axes


def test_an_answer_leaves_what_is_being_typed(page):
    """Another width of the window asks for other samples, whose answer shows all values."""
    phi = page.row("slider.phi").locator("input[type=text]")
    phi.fill("3 deg")
    page.done_after(lambda: page.tab.set_viewport_size({"width": 1100, "height": 720}))
    assert phi.input_value() == "3 deg"
    page.done_after(lambda: phi.press("Enter"))
    assert phi.input_value() == "3 deg"
    page.done_after(lambda: page.tab.click("#undo"))
    assert phi.input_value() == "1 deg"


def test_a_fault_stands_beside_its_field_and_the_picture_stays(page):
    mass = page.row("slider.mass")
    picture = page.picture("#series-still")
    mass.locator("input[type=text]").fill("-1 kg")
    mass.locator("input[type=text]").press("Enter")
    page.until("document.querySelector('[data-path=\"slider.mass\"]').className.includes('faulty')")
    assert "greater than 0" in mass.locator(".fault").inner_text()
    assert "slider.mass" in page.tab.inner_text("#status")
    assert page.picture("#series-still") == picture
    invalid = "document.querySelector('#field-slider-mass').ariaInvalid"
    assert page.value(invalid) == "true"
    mass.locator("input[type=text]").fill("0.3000000001 kg")
    page.done_after(lambda: mass.locator("input[type=text]").press("Enter"))
    assert mass.locator(".fault").inner_text() == ""
    assert page.value(invalid) is None
    assert mass.locator("input").first.input_value() == "0.3000000001 kg"  # as long as one is there
    page.tab.focus("#play")
    assert mass.locator("input").first.input_value() == "0.3 kg"  # the unit was cut out
    assert mass.locator("input").first.get_attribute("title") == "0.3000000001 kg"
    assert page.picture("#series-still") != picture


def test_what_is_old_while_a_long_run_is_computed_says_so(page):
    """Curves and numbers stood beside other parameters, and nothing said that they were old."""
    duration = page.row("run.duration").locator("input[type=text]")
    duration.fill("20000 s")
    duration.press("Enter")
    page.until("document.body.classList.contains('stale')")
    assert page.tab.inner_text("#status") == "computing …"
    duration.fill("200 ms")
    page.done_after(lambda: duration.press("Enter"))
    assert not page.value("document.body.classList.contains('stale')")
    assert "stick intervals" in page.tab.inner_text("#status")


def test_the_animation_runs_and_stands(page):
    start, scene = page.value("stictionPage.t"), page.picture("#scene")
    page.tab.focus("#scene")
    page.tab.keyboard.press("Space")
    page.until(f"stictionPage.t !== {start}")
    page.tab.keyboard.press("Space")
    page.until("document.querySelector('#play').ariaLabel === 'Play'")
    stands = page.value("stictionPage.t")
    drawn = page.value("stictionPage.drawn")
    page.until(f"stictionPage.drawn > {drawn + 3}")
    assert page.value("stictionPage.t") == stands
    assert page.picture("#scene") != scene


def test_the_scrubbers_move_time_at_both_scales(page):
    page.tab.focus("#macro")
    page.tab.keyboard.press("Home")
    page.until("stictionPage.t === 0")
    page.tab.keyboard.press("End")
    page.until("Math.abs(stictionPage.t - 0.25) < 1e-9")
    scrub = "(scrubber) => { scrubber.value = 5e4; scrubber.oninput(); return stictionPage.t; }"
    assert page.tab.eval_on_selector("#macro", scrub) == 0.125  # at once, not at the next frame
    page.tab.focus("#series")
    page.tab.keyboard.press("ArrowLeft")
    t = page.value("stictionPage.t")
    page.until(f"stictionPage.micro?.holds({t})")
    page.tab.focus("#micro")
    page.tab.keyboard.press("ArrowLeft")
    page.until(f"stictionPage.t !== {t}")
    assert abs(page.value("stictionPage.t") - t) < 4e-3  # microseconds, inside four periods


def test_the_state_under_the_microscope_is_that_of_simulate(page):
    page.tab.focus("#macro")
    page.tab.keyboard.press("Home")
    page.until("stictionPage.t === 0 && stictionPage.at?.time === 0")
    page.tab.keyboard.press("PageUp")
    page.until("stictionPage.t > 0 && stictionPage.at?.time === stictionPage.t")
    t = page.value("stictionPage.t")
    wanted = st.simulate(an_opened().description.slider, t, sample_rate=0).final
    for name in ("u_x", "u_y", "friction"):
        found = page.value(f"stictionPage.at.{name}")
        # the last step ends elsewhere; all before are the same
        assert math.isclose(found, float(wanted[name]), rel_tol=1e-6), name


def test_laws_and_protocols_come_from_menus(page):
    page.done_after(lambda: page.tab.select_option("#law", "coulomb"))
    assert page.row("friction.mu_0").count() == 1
    assert page.row("friction.v_f").count() == 0
    page.done_after(lambda: page.tab.select_option("#drive-protocol", "slide-hold-slide"))
    assert page.row("drive.program.2.duration").locator("input[type=text]").input_value()
    page.done_after(lambda: page.tab.select_option("#preset", "den-hartog"))
    assert page.row("drive.program.2.duration").count() == 0
    page.done_after(lambda: page.tab.click("#undo"))
    assert page.row("drive.program.2.duration").count() == 1


def test_the_address_restores_the_state(page):
    page.done_after(lambda: page.tab.click("#reset"))
    phi = page.row("slider.phi").locator("input[type=text]")
    phi.fill("3 deg")
    page.done_after(lambda: phi.press("Enter"))
    page.until("atob(location.hash.slice(1)).includes('3 deg')")  # it follows a little later
    state = page.value("location.hash")
    page.tab.goto("about:blank")
    page.visit(state)
    assert page.row("slider.phi").locator("input[type=text]").input_value() == "3 deg"
    other = {"tables": tables_of(an_opened(duration=0.25).description)}
    other |= {"t": 0.15, "window": [0.1, 0.2], "views": ["constructor", "numbers"]}
    encode = f"({{ encodeState }}) => {{ location.hash = encodeState({json.dumps(other)}); }}"
    page.done_after(lambda: page.value(module("state.js", encode)))  # a link in the same tab
    assert page.value("[stictionPage.t, ...stictionPage.window]") == [0.15, 0.1, 0.2]
    assert page.row("slider.phi").locator("input[type=text]").input_value() == "1 deg"
    assert page.tab.locator("td[data-name='steady sliding']").first.inner_text() == "unstable"


def test_an_address_holds_a_record_and_no_tables_without_a_form(modules):
    """Of 10 000 rows none was written; tables without a law left a page without a form."""
    tables = {"slider": {}, "friction": {"law": "coulomb"}, "drive": {}}
    wrong = [{}, {"slider": {}}, tables | {"drive": 3}, tables | {"drive": {"program": "x"}}]
    found = modules.value(
        module(
            "state.js",
            """({ encodeState, decodeState }) => {
          const there = (tables) => decodeState(encodeState({ tables, rows: Array(3e5).fill(7) }));
          return ALL.map((tables) => there(tables)?.rows.length ?? null);
        }""".replace("ALL", json.dumps([tables, *wrong])),
        )
    )
    assert found == [300_000, None, None, None, None]


def test_two_runs_are_compared(page):
    picture = page.picture("#series-still")
    page.tab.click("#pin")
    phi = page.row("slider.phi").locator("input[type=text]")
    phi.fill("8 deg")
    page.done_after(lambda: phi.press("Enter"))
    page.tab.click("#panel-b [data-view=numbers]")
    assert page.tab.locator("#panel-b tr").nth(1).locator("td").count() == 2
    page.done_after(lambda: page.tab.click("#swap"))
    assert phi.input_value() == "1 deg"
    assert page.picture("#series-still") != picture


def test_the_point_of_the_map_is_moved_by_mouse_and_keyboard(page):
    page.until("stictionPage.data.stability?.arrays.growth.shape[0] === 12")
    box = page.tab.locator("#panel-a canvas[role=img]").bounding_box()
    place = box["x"] + 0.8 * box["width"], box["y"] + 0.4 * box["height"]
    page.done_after(lambda: page.tab.mouse.click(*place))
    phi = page.row("slider.phi").locator("input[type=text]")
    angle = float(phi.input_value().removesuffix(" deg"))
    assert angle > 5.0
    page.tab.focus("#panel-a canvas[role=img]")
    page.done_after(lambda: page.tab.keyboard.press("ArrowRight"))
    assert float(phi.input_value().removesuffix(" deg")) > angle


def test_the_limit_of_stability_lies_between_its_cells(modules):
    """A straight limit is exact, whatever its slope; beside what is unknown it lies half-way."""
    x, y = (np.arange(5) + 0.5) / 5, (np.arange(7)[:, None] + 0.5) / 7
    steps = np.select([x < 0.4, x < 0.6], [1.0, np.nan], -1.0) + 0.0 * y
    maps = [0.3 + 0.4 * y - x, steps, 2.0 + 0.0 * x * y, -2.0 + 0.0 * x * y]
    values = json.dumps([each.ravel().tolist() for each in maps])
    use = f"({{ signChange }}) => {values}.map((each) => signChange(each, 7, 5))"
    found = modules.value(module("contour.js", use))
    parts = [sum(area_of(each) for each in one["areas"]) for one in found]
    assert parts == pytest.approx([0.5, 0.4, 1.0, 0.0])
    across, up = np.array(found[0]["lines"]).reshape(-1, 2).T
    inner = abs(up - 0.5) < 0.5 - 0.5 / 7  # to the edges, the values of their cells go on
    assert across[inner] == pytest.approx(0.3 + 0.4 * up[inner], abs=1e-12)


def area_of(polygon):
    """Return the area of a polygon, whose corners go round it anticlockwise (C. F. Gauss)."""
    x, y = np.transpose(polygon)
    return 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))


def test_zooming_asks_for_the_window(page):
    page.tab.focus("#series")
    page.tab.keyboard.press("+")
    page.until("stictionPage.window?.length === 2")
    low, high = page.value("stictionPage.window")
    assert math.isclose(high - low, 0.125, rel_tol=1e-6)
    page.tab.keyboard.press("Home")
    page.until("stictionPage.window === null")


def test_the_oscillation_is_heard(page):
    page.tab.select_option("#speed", "10")
    page.tab.click("#sound")
    page.until("stictionPage.sound.buffer?.length > 0")
    assert page.value("stictionPage.sound.buffer.sampleRate") == 48000
    assert page.value("stictionPage.sound.buffer.length") == 12000
    page.tab.click("#play")
    page.until("stictionPage.sound.source !== undefined")
    page.tab.click("#play")
    page.until("stictionPage.sound.source === undefined")


def test_everything_is_exported(page):
    page.tab.select_option("#export", "python")
    page.tab.wait_for_selector("dialog pre")
    assert page.tab.locator("dialog").get_attribute("aria-label") == "run.py"
    assert "st.Slider(mass=0.25" in page.tab.inner_text("dialog pre")
    page.tab.keyboard.press("Escape")
    for kind, name in (("nc", "run.nc"), ("png", "run.png")):
        with page.tab.expect_download() as kept:
            page.tab.select_option("#export", kind)
        assert kept.value.suggested_filename == name
        assert kept.value.path().stat().st_size > 1000


def test_what_cannot_be_asked_says_why(page):
    """Of the socket that a large request had closed it said "computing" for ever."""
    status = "document.querySelector('#status').textContent"
    said = page.value(
        """new Promise((done) => stictionPage.link.ask(
        { do: "zoom", lane: 1, pad: "x".repeat(2 ** 24) }, done, ({ error }) => done(error)))"""
    )
    assert "too large for the page" in said
    page.value("stictionPage.link.socket.close()")
    page.until(f"{status}.startsWith('the explorer was closed')")
    page.tab.select_option("#export", "toml")
    assert page.value(status).startswith("the explorer was closed")
    page.tab.select_option("#preset", "den-hartog")
    assert page.value(status).startswith("the explorer was closed")


def test_all_is_reached_by_the_keyboard_and_named(page):
    bare = page.value(
        """[...document.querySelectorAll('button, select, input, canvas')].filter((each) =>
        !each.ariaHidden && !each.ariaLabel && !each.labels?.length && !each.textContent.trim()
        && !each.title).map((each) => each.outerHTML)"""
    )
    assert bare == []
    hidden = page.value(
        "[...document.querySelectorAll('button, select, input')].filter((each) =>"
        " each.tabIndex < 0 && each.getAttribute('role') !== 'tab').length"
    )
    assert hidden == 0
    clocks = page.value(
        "[...document.querySelectorAll('#macro, #micro')].map((x) => x.ariaValueText)"
    )
    assert all(re.fullmatch(r"t = [\d.]+ s", words) for words in clocks)
    live = page.value("document.querySelectorAll('output, [role=status], [aria-live]').length")
    assert live == 1  # the status, not the clock that runs
    page.tab.focus("#panel-a [role=tab][aria-selected=true]")
    page.tab.keyboard.press("ArrowRight")
    assert page.value("document.activeElement.dataset.view") == "phase"
    ring = "getComputedStyle(document.activeElement).outlineStyle"
    assert page.value(ring) == "solid"  # one sees where one is


def test_each_view_is_told_in_words(page):
    """A canvas named "Stability" was all that a screen reader had of it."""
    said = {}
    label = "document.querySelector('#panel-a canvas[role=img]').ariaLabel"
    for name in ("stability", "phase", "damping", "spectrogram"):
        page.tab.click(f"#panel-a [data-view={name}]")
        page.until(f"{label}.includes(': ') && !{label}.endsWith('computing')")
        said[name] = page.value(label)
    place = "at φ = 1 deg, V = 1 mm/s; arrow keys move the point"
    assert said["stability"] == f"Stability: steady sliding is unstable {place}"
    assert re.fullmatch(
        r"Phase: velocity X′, \S+ .?m/s to \S+ .?m/s, over spring force k_x u_x, 0 N to \d+ mN",
        said["phase"],
    )
    path = "A = 3624; friction turns from 90 deg to 1 deg; ζ falls below 1 at 3.73 deg"
    assert said["damping"] == f"Damping: {path}"
    assert re.fullmatch(
        r"Spectrum: transverse rate v_y, .* to .*Hz, strongest at (1 k|9\d0 )Hz",
        said["spectrogram"],
    )


def test_it_fits_a_small_projector(page):
    """Nothing is cut off at 1280 x 720, and no text is smaller than 11 px."""
    assert page.value("document.documentElement.scrollWidth") <= 1280
    cut = page.value(
        """[...document.querySelectorAll('header *, #transport *, #side button, canvas')]
        .filter((each) => { const b = each.getBoundingClientRect();
          return b.width && (b.right > 1281 || b.bottom > 721); }).map((each) => each.outerHTML)"""
    )
    assert cut == []
    small = page.value(
        """[...document.querySelectorAll('body *')].filter((each) => each.textContent.trim()
        && parseFloat(getComputedStyle(each).fontSize) < 11).map((each) => each.outerHTML)"""
    )
    assert [each for each in small if not each.startswith("<sub")] == []


@pytest.mark.parametrize("size", [(1366, 620), (1060, 700), (1024, 600), (390, 844)])
def test_a_smaller_window_scrolls_and_keeps_its_curves(page, size):
    """In 1024 x 600 px five strips shared 40 px; on a phone half the page lay beside the screen."""
    width, height = size
    page.tab.set_viewport_size({"width": width, "height": height})
    page.until("stictionPage.settled")
    assert page.value("document.documentElement.scrollWidth") <= width
    assert page.value("document.querySelector('#series-still').clientHeight") >= 5 * 55
    page.tab.click("#pin")  # with one more button beside the status
    status = "document.querySelector('#status')"
    assert page.value(f"{status}.scrollHeight <= {status}.clientHeight")  # nothing is cut off
    long = page.value(f"""((its) => {{
      const said = its.textContent;
      its.textContent = said.padEnd(110, ' and more words');
      const heights = [its.scrollHeight, its.clientHeight];
      its.textContent = said;
      return heights;
    }})({status})""")
    assert long[0] <= long[1]  # nor of a message, for which there is a line of its own
    assert page.value(f"{status}.title === {status}.textContent")
    beside = page.value(
        """[...document.querySelectorAll('header *, #transport *, .row *, canvas')]
        .filter((each) => {
          const b = each.getBoundingClientRect(), box = each.closest('form, header, main');
          return b.width && b.right > box.getBoundingClientRect().right + 1;
        }).map((each) => each.outerHTML)"""
    )
    assert beside == []


def test_no_name_of_a_parameter_is_cut_off(page):
    """`sample rate` was "sample r...", on the line where it is changed."""
    page.value(
        "document.querySelectorAll('#parameters details').forEach((x) => { x.open = true; })"
    )
    cut = page.value(
        """[...document.querySelectorAll('.row label')].filter((each) =>
        each.clientWidth && each.scrollWidth > each.clientWidth).map((each) => each.textContent)"""
    )
    assert cut == []


def test_tooltips_are_plain_words_and_one_stick_is_one_interval(page):
    """They had the backquotes of docstrings; a short run had "1 stick intervals"."""
    titles = page.value("[...document.querySelectorAll('[title]')].map((each) => each.title)")
    assert len(titles) > 30
    assert [title for title in titles if "`" in title] == []
    duration = page.row("run.duration").locator("input[type=text]")
    for lasts, says in (("12 ms", "1 stick interval, "), ("10 ms", "it never slipped: ")):
        duration.fill(lasts)
        page.done_after(lambda: duration.press("Enter"))
        assert page.tab.inner_text("#status").startswith(says)


def contrast(*colors):
    """Return the contrast of two colours (W3C, Web Content Accessibility Guidelines 2.2, 1.4.3)."""
    parts = [[x / 255 for x in each] for each in colors]
    linear = [
        [x / 12.92 if x <= 0.03928 else ((x + 0.055) / 1.055) ** 2.4 for x in each]
        for each in parts
    ]
    low, high = sorted(0.2126 * r + 0.7152 * g + 0.0722 * b for r, g, b in linear)
    return (high + 0.05) / (low + 0.05)


def white_in(scheme, modules):
    """Return the white of a page that is light or dark, once it is so."""
    modules.tab.emulate_media(color_scheme=scheme)
    white = module("drawing.js", '({ shade }) => shade("#fff")')
    until(lambda: (modules.value(white) == "#fff") == (scheme == "light"), scheme)
    return modules.value(white)


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_stripes_have_contrast_and_the_ground_of_the_page(modules, scheme):
    """In a dark page those of runs that a study lacks stood on white, with 2.4 : 1 or less."""
    white = white_in(scheme, modules)
    pixels = modules.value(
        module(
            "views.js",
            """({ hatching }) => {
          const context = new OffscreenCanvas(24, 24).getContext("2d");
          context.fillStyle = hatching(document.createElement("canvas").getContext("2d"));
          context.fillRect(0, 0, 24, 24);
          return [...context.getImageData(0, 0, 24, 24).data];
        }""",
        )
    )
    colors = sorted({tuple(pixels[i : i + 3]) for i in range(0, len(pixels), 4)})
    ground = tuple(modules.value(f"({CHANNELS})({[white]})")[0])
    assert ground == colors[-1 if scheme == "light" else 0]
    assert contrast(colors[0], colors[-1]) >= 3.0
    drawn = modules.value(
        module(
            "drawing.js",
            """({ contextOf }) => {
          const context = contextOf(document.createElement("canvas"));
          context.fillStyle = context.strokeStyle = "#fff";
          return [context.fillStyle, context.strokeStyle];
        }""",
        )
    )
    assert modules.value(f"({CHANNELS})({drawn})") == [[*ground]] * 2


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_letters_have_contrast(modules, scheme):
    """Those of k_y had 2.05 : 1 on the floor, and the ring about what is focused 2.25 : 1."""
    white_in(scheme, modules)
    known = modules.value(module("drawing.js", "({ ...all }) => all"))
    names = ("INK", "SOFT", "BLUE", "RED", "GREEN", "ORANGE", "PURPLE", "GREY")
    letters = [known["LETTERS"].get(known[name], known[name]) for name in names]
    drawn = modules.value(
        module("drawing.js", f"({{ shade }}) => {[*letters, known['FLOOR']]}.map(shade)")
    )
    *drawn, floor = modules.value(f"({CHANNELS})({drawn})")
    for name, color in zip(names, drawn, strict=True):
        assert contrast(color, floor) >= 4.5, name
    variables = ["--ink", "--soft", "--blue", "--bad", "--paper", "--ground", "--on-blue"]
    *letters, paper, ground, on_blue = modules.value(f"({CHANNELS})({variables})")
    assert min(contrast(each, under) for each in letters for under in (paper, ground)) >= 4.5
    assert contrast(letters[variables.index("--blue")], on_blue) >= 4.5
    modules.tab.focus("#series")
    modules.tab.keyboard.press("Shift")
    ring = "getComputedStyle(document.activeElement).outlineColor"
    assert modules.value(ring) == f"rgb({', '.join(map(str, letters[2]))})"


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_curves_keep_their_contrast_where_the_mass_rests(modules, scheme):
    """That of k_y u_y fell from 2.3 to 1.6 : 1, and in a dark page from 3.5 to 2.3 : 1."""
    paper = modules.value(f"({CHANNELS})({[white_in(scheme, modules)]})")[0]
    drawn = "({ ORANGE, rest, shade }) => [ORANGE, rest()].map(shade)"
    orange, veil = modules.value(module("drawing.js", drawn))
    *grey, alpha = map(float, re.findall(r"[\d.]+", veil))
    shaded = [x + alpha * (y - x) for x, y in zip(paper, grey, strict=True)]
    orange = modules.value(f"({CHANNELS})({[orange]})")[0]
    assert contrast(orange, shaded) > 0.8 * contrast(orange, paper)


# Red, green and blue of colours, or of variables of the page's style
CHANNELS = """(colors) => {
  const style = getComputedStyle(document.body);
  const context = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  return colors.map((color) => {
    context.fillStyle = color.startsWith("--") ? style.getPropertyValue(color).trim() : color;
    context.fillRect(0, 0, 1, 1);
    return [...context.getImageData(0, 0, 1, 1).data.subarray(0, 3)];
  });
}"""


def test_a_page_that_turns_dark_is_drawn_anew(page):
    """Its curves were light ones on a dark ground until the next run."""
    shown = page.drawn_picture("#series-still")
    page.tab.emulate_media(color_scheme="dark")
    until(lambda: page.picture("#series-still") != shown, "dark curves")
    white = page.value(module("drawing.js", '({ shade }) => shade("#fff")'))
    paper = "getComputedStyle(document.querySelector('.layers')).backgroundColor"
    assert page.value(paper) == white.replace(",1)", ")").replace("rgba", "rgb").replace(",", ", ")
    page.tab.emulate_media(color_scheme="light")
    until(lambda: page.picture("#series-still") == shown, "the curves as they were")


def test_ticks_of_a_study_have_the_prefix_of_its_axis(modules):
    """0.0003 and 0.0095 m/s reached into the name of the axis."""
    made = modules.value(
        """import(new URL("axis.js", document.querySelector("script[type=module]").src)).then(
        ({ cellAxis }) => cellAxis([3e-4, 9.5e-4, 3e-3, 9.5e-3, 0.03], "m/s"))"""
    )
    assert made["unit"] == "mm/s"
    assert [words for _, words in made["ticks"]] == ["0.3", "0.95", "3", "9.5", "30"]


def module(name, use):
    """Return what a function makes of a module of the page, of which it gives an expression."""
    return (
        f'import(new URL("{name}", document.querySelector("script[type=module]").src)).then({use})'
    )


def test_the_labels_of_ticks_are_not_cut_off_or_in_another_frame(modules):
    """Of 0.30 at the end of the time axis one saw 0.3; 0 and 1 of two strips lay on each other."""
    across, up = modules.value(
        module(
            "drawing.js",
            """({ frame }) => {
          const canvas = document.createElement("canvas"), found = [[], []];
          canvas.width = 300;
          const context = canvas.getContext("2d");
          context.fillText = (words, x, y) => {
            const aside = context.textAlign === "right";
            found[Number(aside)].push(aside ? y : x + context.measureText(words).width / 2);
          };
          const axis = { place: (value) => value, ticks: [[0, "0.00"], [1, "0.30"]] };
          frame(context, { left: 50, top: 10, width: 245, height: 50 }, axis, axis);
          return found;
        }""",
        )
    )
    assert across[0] < 75.0
    assert 290.0 < across[1] <= 300.0
    assert up == [54.0, 16.0]


@pytest.mark.parametrize(
    ("low", "high", "unit", "offset", "named"),
    [
        (40.001985, 40.001965, "deg", "0 = 40.00197", "µdeg"),  # reached into the axis' name
        (-145.5, -145.3, "deg", "0 = −145.4", "deg"),
        (1.4429026, 1.4429027, "N", "0 = 1.4429026", "nN"),
        (3.75e-3, 3.77e-3, "m", "", "mm"),
        (-180.0, 180.0, "deg", "", "deg"),
        (0.0, 2e-5, "deg", "", "µdeg"),
        (1.1, 1.45, "N", "", "N"),
        (145e3, 145.001e3, "N/m", "0 = 145.0005 kN/m", "N/m"),
    ],
)
def test_numbers_at_ticks_have_their_digits_and_their_place(
    modules, low, high, unit, offset, named
):
    """A single tick at 1.2 was labelled 1; ticks at 40.00199 had no place."""
    low, high = sorted((low, high))
    for count in (1, 2, 3, 5):
        made, widths = modules.value(
            module(
                "axis.js",
                f"""({{ linearAxis }}) => {{
              const axis = linearAxis({low!r}, {high!r}, {count}, "{unit}");
              const context = document.createElement("canvas").getContext("2d");
              context.font = '12px system-ui, "Segoe UI", "DejaVu Sans", sans-serif';
              return [axis, axis.ticks.map(([, label]) => context.measureText(label).width)];
            }}""",
            )
        )
        assert max(widths, default=0.0) <= 41.0  # px beside the narrowest frame
        assert made["offset"].startswith(offset) if offset else made["offset"] == ""
        assert made["unit"] == named
        zero = 0.0
        if offset:
            digits = re.search(r"0 = (−?[\d.]+) (k|m|)", made["offset"])
            scale = {"k": 1e3, "m": 1e-3}.get(digits[2] if unit != "m" else "", 1.0)
            zero = float(digits[1].replace("−", "-")) * scale
        for value, label in made["ticks"]:
            shown = float(label.replace("−", "-")) / made["factor"]
            assert value == pytest.approx(zero + shown, abs=1e-6 * (high - low))
            assert low - 1e-9 * abs(low) <= value <= high + 1e-9 * abs(high)


def test_rounding_is_not_drawn_as_motion(modules):
    same, moved = modules.value(
        module(
            "axis.js",
            "({ padded }) => [padded(2, 2 * (1 + 2e-15), 0.05), padded(2, 2 + 1e-9, 0.05)]",
        )
    )
    assert same == pytest.approx([1.9, 2.1])
    assert moved[1] - moved[0] == pytest.approx(1.1e-9, rel=1e-3)


def test_silence_is_explained(page):
    """Of a rig too fast to be heard, folded samples were played at any speed."""
    words = page.value(
        module(
            "sound.js",
            """({ Sound }) => {
          const sound = Object.assign(new Sound(), { speed: 0.01, start: 0, end: 0.6 });
          return [[0.1, 10], [0.1, 100], [0.7, 1000]].map(([t, slow]) => sound.silent(t, slow));
        }""",
        )
    )
    assert words == [
        "too high to be heard at 1 : 10: choose 1 : 100 or slower",
        "",
        "the sound is that of 0 s to 600 ms",
    ]
    page.tab.click("#sound")
    page.until("Boolean(stictionPage.sound.buffer)")
    before = page.tab.inner_text("#status")
    page.tab.select_option("#speed", "0.1")
    assert page.tab.inner_text("#status").startswith("no sound: too high to be heard at 10 : 1")
    page.tab.select_option("#speed", "10")
    assert page.tab.inner_text("#status") == before
    page.tab.click("#sound")


def test_a_spectrum_that_cannot_be_says_why(page):
    """It said "computing" for ever."""
    write_down(page)
    page.tab.click("#panel-a [data-view=spectrogram]")
    page.until("stictionPage.spectrogram")
    page.value(
        """(() => { const { link } = stictionPage;
        const { id } = link.newest.get("spectrogram/0");
        link.receive({ do: "spectrogram", lane: 0, id, error: "the run ended before it" }); })()"""
    )
    page.until("written.includes('the run ended before it')")


@pytest.mark.parametrize("damping", [1e-1, 1.0, 3e3, 2e7, 5e11])
def test_the_numbers_in_the_damping_diagram_lie_apart(modules, damping):
    boxes = modules.value(
        module(
            "views.js",
            """({ VIEWS }) => {
          const canvas = document.createElement("canvas"), found = [];
          [canvas.width, canvas.height] = [330, 200];
          const context = canvas.getContext("2d");
          context.font = "12px sans-serif";
          context.fillText = (words, x, y) => {
            if (context.textAlign !== "left") return;
            found.push([words, x, x + context.measureText(words).width, y]);
          };
          new VIEWS.damping().still(context, 330, 200, { scene: { damping: DAMPING, phi: 0.1 } });
          return found;
        }""".replace("DAMPING", str(damping)),
        )
    )
    boxes = [box for box in boxes if box[0].startswith(("10", "ζ"))]
    assert len(boxes) > 4
    assert "ζ = 1" in [box[0] for box in boxes]
    for at, (_, left, right, y) in enumerate(boxes):
        for _, other_left, other_right, other in boxes[:at]:
            assert left > other_right or other_left > right or abs(y - other) >= 14


def test_what_does_not_move_has_no_magnification(modules):
    """A rig without misalignment had "u_y × 0"."""
    said = modules.value(
        module(
            "scene.js",
            """({ Scene }) => {
          const factors = (x, y) =>
            Scene.prototype.factors.call({ lengths: { x, y } }, { x: 4e4, y: 4 });
          return [factors(1, 0), factors(1, 1), factors(0, 0)];
        }""",
        )
    )
    assert said[0].startswith("u_x × ")
    assert "u_y" not in said[0]
    assert "u_y" in said[1]
    assert said[2] == "nothing moves"


def write_down(page):
    """Keep the words that are drawn in the upper view at the side from now on."""
    still = "document.querySelector('#panel-a .layers canvas')"
    page.value(
        f"""(() => {{ const context = {still}.getContext("2d"), write = context.fillText;
        window.written = [];
        context.fillText = (words, ...at) => {{ written.push(words);
          write.call(context, words, ...at); }}; }})()"""
    )


def test_the_menus_of_tests_say_what_is_there(page):
    """With a vibration across, the menu said "constant velocity", as did an entry below."""

    def shown(table):
        return page.value(
            f"""(() => {{ const menu = document.querySelector("#{table}-protocol");
            return [menu.selectedOptions[0], ...menu.options].map((each) => each.text); }})()"""
        )

    def choose(table, name):
        page.done_after(lambda: page.tab.select_option(f"#{table}-protocol", name))

    page.tab.click("#panel-a [data-view=numbers]")
    cases = [
        ("drive", "harmonic", "program of 1 piece"),
        ("drive", "vibration across", "constant velocity, with a harmonic"),
        ("load", "harmonic load", "constant load, with a harmonic"),
    ]
    for table, name, words in cases:
        constant = f"constant {'velocity' if table == 'drive' else 'load'}"
        if shown(table)[0] != constant:
            choose(table, constant)
        assert shown(table)[0] == constant
        choose(table, name)
        for found in (shown("drive"), shown("load")):
            assert len(set(found[1:])) == len(found) - 1  # no two entries of one name
        assert shown(table)[0] == words


def test_a_map_that_cannot_be_says_of_what(page):
    """It began with "is not steady", and did not say what."""
    write_down(page)
    page.done_after(lambda: page.tab.select_option("#drive-protocol", "slide-hold-slide"))
    page.until("written.some((words) => words.includes('not steady'))")
    assert [words for words in page.value("written") if words.startswith("drive: is not")]


def test_a_study_shows_what_its_colours_mean(browser, tmp_path):
    """A click on a run without a value opens it, too."""
    study = st.Study(
        base=an_opened(duration=2e-3).description,
        axes={"phi": st.Values(["1 deg", "2 deg"]), "V": st.Values(["1 mm/s", "100 mm/s"])},
        measures=["peak_force"],
    )
    st.sweep(study, tmp_path / "a.zarr")
    what = open_sources([tmp_path / "a.zarr"])
    what.study.data["peak_force"].values[1, 0] = math.nan
    with serving(what) as explorer:
        page = Page(browser.new_page(viewport=SIZE), explorer)
        page.visit("")
        write_down(page)
        canvas = "#panel-a canvas[role=img]"
        box = page.tab.locator(canvas).bounding_box()
        page.done_after(
            lambda: page.tab.click(
                canvas, position={"x": 0.6 * box["width"], "y": 0.7 * box["height"]}
            )
        )
        page.drawn_picture(canvas)
        written = page.value("written")
        assert [words for words in written if re.fullmatch(r"peak force \(.?N\)", words)]
        assert "no value" in written
        assert page.row("slider.phi").locator("input[type=text]").input_value() == "2 deg"
        assert page.said == []
        page.tab.close()


def test_closing_the_page_ends_its_computation(browser, explorer):
    others, tab = len(explorer._pages), browser.new_page()
    made = Page(tab, explorer)
    made.visit("")
    assert len(explorer._pages) == others + 1
    tables = tables_of(an_opened().description)
    tables["run"]["duration"] = "100000 s"
    made.value(f"stictionPage.link.ask({{do: 'zoom', tables: {tables}, window: [0, 1]}}, () => 0)")
    tab.close()
    until(lambda: len(explorer._pages) == others, "what was computed for the page")


def test_the_words_beside_the_apparatus_have_no_rounding(modules):
    """At the start of a rig turned by 2 deg, they were ψ = -4.441e-16° and < 0.001 nN."""
    said = modules.value(
        module(
            "scene.js",
            """({ Scene }) => {
          const context = document.createElement("canvas").getContext("2d"), said = [];
          context.fillText = (words) => said.push(words);
          const own = Object.create(Scene.prototype);
          own.scene = { phi: Math.PI / 90, k: [2300, 9e5] };
          own.lengths = { x: 1e-3, y: 1e-6 };
          own.factors = () => "";
          own.words(context, 900, 300, {
            slip_x: 1e-9, slip_y: 0, friction: 2.4, theta: 2 + 4e-16, u_x: 7.5e-37, sticking: false,
          }, {});
          return said.join("|");
        }""",
        )
    )
    assert "2.4 N, ψ = 0°" in said
    assert "0 N" in said.split("|")


def names_on(page):
    """Return the name in the header, the window's title and the choice of the menu of presets."""
    return page.value(
        """(() => { const menu = document.querySelector("#preset");
        return [document.querySelector("#name").textContent,
          document.title.replace(" · stiction explorer", ""),
          menu.selectedOptions[0].textContent]; })()"""
    )


def test_the_header_names_the_system_that_is_shown(page):
    """It stayed "Nakano & Popov 2020, Fig. 3", whichever preset or law was chosen."""
    assert names_on(page) == ["a test", "a test", "choose …"]
    page.done_after(lambda: page.tab.select_option("#preset", "leine-belt"))
    title = st.presets.find("leine-belt").title
    assert names_on(page) == [title, title, "leine-belt"]
    page.done_after(lambda: page.tab.select_option("#law", "coulomb"))
    assert names_on(page) == [f"{title}, changed"] * 2 + ["leine-belt, changed"]
    page.done_after(lambda: page.tab.click("#undo"))
    assert names_on(page) == [title, title, "leine-belt"]
    page.done_after(lambda: page.tab.click("#undo"))
    assert names_on(page) == ["a test", "a test", "choose …"]
    page.done_after(lambda: page.tab.click("#redo"))
    duration = page.row("run.duration").locator("input[type=text]")
    duration.fill("30 s")
    page.done_after(lambda: duration.press("Enter"))
    assert names_on(page) == [title, title, "leine-belt"]  # the same system over another time
    page.done_after(lambda: page.tab.click("#reset"))
    assert names_on(page) == ["a test", "a test", "choose …"]


def test_the_microscope_is_as_wide_as_suits_the_system(page):
    """It kept 4 ms in the run of a preset that lasts hours."""
    wide = "stictionPage.micro.end - stictionPage.micro.start"
    before = page.value(wide)
    page.done_after(lambda: page.tab.select_option("#preset", "den-hartog"))
    page.settle()
    assert page.value(wide) == pytest.approx(8.0 * math.pi)  # four periods of m = k = 1
    page.done_after(lambda: page.tab.click("#undo"))
    page.settle()
    assert page.value(wide) == pytest.approx(before)


def test_nothing_of_the_rig_before_stands_beside_the_new_one(page):
    """Map and microscope showed the rig before until they were computed."""
    stands = """[...document.querySelectorAll("#microscope .layers, #panel-a .layers")].map(
        (each) => [each.classList.contains("stale"), getComputedStyle(each.children[0]).opacity])"""
    mass = page.row("slider.mass").locator("input[type=text]")
    page.until("stictionPage.data.stability?.arrays.growth.shape[0] === 12")
    assert page.value(stands) == [[False, "1"]] * 2
    page.value(
        """(() => { const { link } = stictionPage, receive = link.receive.bind(link);
        window.held = [];
        link.receive = (answer) => (["stability", "fine"].includes(answer.do)
          ? held.push(answer) : receive(answer));
        window.release = () => { link.receive = receive; held.forEach(receive); }; })()"""
    )
    mass.fill("300 g")
    page.tab.keyboard.press("Enter")
    page.until(f"{SHOWN} && stictionPage.shown.asked === stictionPage.asked && held.length > 3")
    assert page.value(stands) == [[True, "0.4"]] * 2  # of another mass
    page.value("release()")
    page.settle()
    page.until("stictionPage.data.stability?.arrays.growth.shape[0] === 12")
    assert page.value(stands) == [[False, "1"]] * 2


def test_of_a_rig_before_a_preset_nothing_stands(page):
    write_down(page)
    page.value(
        """(() => { const { link } = stictionPage, receive = link.receive.bind(link);
        link.receive = (answer) => ["stability", "fine"].includes(answer.do) || receive(answer);
        })()"""
    )
    page.done_after(lambda: page.tab.select_option("#preset", "leine-belt"))
    page.until("written.includes('computing …')")
    assert page.value("stictionPage.data.stability") is None
    assert page.value("stictionPage.micro") is None
    assert (
        page.tab.locator("#panel-a canvas[role=img]")
        .get_attribute("aria-label")
        .endswith("computing")
    )


@pytest.mark.parametrize("phi", [-60, -30, 0, 30, 60])
@pytest.mark.parametrize("size", [(660, 270), (380, 290)])
def test_springs_and_their_walls_lie_inside_the_picture(modules, phi, size):
    """Turned by 30 deg, they left it."""
    points = modules.value(
        module(
            "scene.js",
            """({ Scene }) => {
          const [width, height] = SIZE, phi = (PHI * Math.PI) / 180, found = [];
          const c = Math.cos(phi), n = Math.sin(phi);
          const turn = (x, y) => [x * c + y * n, x * n - y * c];
          const canvas = document.createElement("canvas");
          [canvas.width, canvas.height] = [width, height];
          const context = canvas.getContext("2d");
          context.moveTo = context.lineTo = (x, y) => found.push([x, y]);
          const scene = Object.create(Scene.prototype), home = [0.43 * width, 0.56 * height];
          Object.assign(scene, { scene: { phi }, lengths: { x: 1e-3, y: 1e-6 } });
          const M = scene.magnification(width, height);
          for (const u of [-1e-3, 0, 1e-3]) {
            const mass = turn(M.x * u, 0).map((each, i) => home[i] + each);
            scene.springs(context, width, height, 0, home, mass, turn, M);
          }
          return found;
        }""".replace("PHI", str(phi)).replace("SIZE", json.dumps(size)),
        )
    )
    width, height = size
    assert len(points) > 30
    assert all(0 <= x <= width and 0 <= y <= height for x, y in points)


def test_magnifications_have_the_words_of_a_film(modules):
    """The caption said u_x × 0 where the film has × 0.00084."""
    factors = [8.4e-4, 2e-7, 0.05, 3.1, 20.0, 1e3, 12345.0, 5e5, 1e6, 5e8, 2e9]
    said = modules.value(module("scene.js", f"({{ count }}) => {factors}.map(count)"))
    assert said == [factor_in_words(each) for each in factors]


def test_values_have_the_units_of_descriptions(modules):
    """A mass of 60 kt was 6e+10 g."""
    cases = [(6e7, "kg"), (0.25, "kg"), (1e-5, "N*s/m"), (0.02, "Hz"), (1e10, "N/m"), (0.0, "N")]
    said = modules.value(
        module(
            "quantity.js", f"({{ quantity }}) => {json.dumps(cases)}.map((it) => quantity(...it))"
        )
    )
    assert said == [quantity_text(*each).replace("u", "µ") for each in cases]
