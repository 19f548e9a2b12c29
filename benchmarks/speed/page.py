"""``python -m benchmarks.speed.page``: from a slider to redrawn curves, and frames a second.

The explorer runs as its users start it, the paper's case over 5 s, in Chromium of 1280 x 720. A
slider is moved again and again, as a hand does; counted is the time from the event to the end of
the frame in which the new curves are drawn. Chromium draws without a graphics card.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from playwright.sync_api import sync_playwright

SLIDERS = ("friction.mu_inf", "slider.k_x", "slider.phi", "drive.velocity")
GOALS = {"median": 60.0, "95 %": 120.0}  # ms
SHOWN = "Boolean(window.stictionPage?.shown) && !stictionPage.shown.quick"
SLIDE = """async ([path, moves, pause]) => {
  const slider = document.querySelector(`[data-slider="${path}"]`), first = Number(slider.value);
  const found = [];
  for (let i = 0; i < moves; i++) {
    slider.value = first + 40 * Math.sin(i / 5);
    const moved = performance.now();
    slider.dispatchEvent(new Event("input", { bubbles: true }));
    while (!(stictionPage.latency?.asked >= moved)) await new Promise((go) => setTimeout(go, 1));
    found.push(stictionPage.latency.drawn - moved);
    await new Promise((go) => setTimeout(go, pause));
  }
  slider.value = first;
  slider.dispatchEvent(new Event("change", { bubbles: true }));
  return found;
}"""
FRAMES = """async (seconds) => {
  const times = [];
  await new Promise((done) => {
    const note = (now) => (times.push(now), times.at(-1) - times[0] < 1e3 * seconds
      ? requestAnimationFrame(note) : done());
    requestAnimationFrame(note);
  });
  return times;
}"""


@contextmanager
def explorer() -> Iterator[str]:
    """Start the explorer as a command; yield its address."""
    command = [sys.executable, "-m", "stiction", "explore", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        yield process.stdout.readline().rsplit(" ", 1)[-1].strip()
        process.terminate()


@contextmanager
def chromium(address: str) -> Iterator[Any]:
    """Open the page; yield its tab."""
    with sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=shutil.which("chromium"), args=["--no-sandbox", "--disable-gpu"]
        )
        tab = browser.new_page(viewport={"width": 1280, "height": 720})
        tab.goto(address)
        while not tab.evaluate(SHOWN):
            time.sleep(0.1)
        yield tab
        browser.close()


def main() -> int:
    """Measure; return 1 if a goal is missed."""
    parser = argparse.ArgumentParser(description=__doc__.partition(":")[2].strip())
    parser.add_argument("--moves", type=int, default=100, help="of each slider")
    parser.add_argument("--picture", help="where to write a screenshot (.png)")
    options = parser.parse_args()
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    with explorer() as address, chromium(address) as tab:
        time.sleep(5.0)  # the map is drawn
        if options.picture:
            tab.screenshot(path=options.picture)
        found = []
        for path in SLIDERS:
            took = tab.evaluate(SLIDE, [path, options.moves, 30])
            found += took[5:]
            print(f"{path}: median {np.median(took):.0f} ms, 95 % {np.quantile(took, 0.95):.0f} ms")
            time.sleep(1.0)
        tab.click("#play")
        frames = np.diff(tab.evaluate(FRAMES, 5))
    print(f"animation: {1e3 / frames.mean():.1f} frames a second, longest {frames.max():.0f} ms")
    medians = {"median": float(np.median(found)), "95 %": float(np.quantile(found, 0.95))}
    for name, goal in GOALS.items():
        print(f"from slider to curves, {name}: {medians[name]:.0f} ms (goal {goal:.0f} ms)")
    return int(any(medians[name] > goal for name, goal in GOALS.items()))


if __name__ == "__main__":
    sys.exit(main())
