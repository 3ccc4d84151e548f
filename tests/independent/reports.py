"""Opens reports in Chromium as people do, and looks at what they show.

    reports.py CHROMIUM BRYANT FOLDER [REPORT.html …]

Other reports are only opened.
"""

import re
import subprocess
import sys
from pathlib import Path

from chromium import Browser, Page

PHONE = {"size": (390, 844), "touch": True}
STUDY = """\
model: child-seat
design: latin hypercube
runs: 40
parameters: { lap_slack: { from: 0 mm, to: 40 mm }, friction: { from: 0.1, to: 0.6 } }
responses: [{ of: lap belt force, what: peak }]
"""


def pages(pdf):
    """How many pages a PDF has."""
    return len(re.findall(rb"/Type\s*/Page\b", pdf))


def expect(condition, what):
    if not condition:
        raise AssertionError(what)


def whole(page):
    """Nothing failed, and nothing is beside the window."""
    expect(not page.faults(), page.faults())
    across = page.js("[document.documentElement.scrollWidth, innerWidth]")
    expect(across[0] <= across[1], f"the page is {across[0]} px wide, the window {across[1]}")


def ground(page):
    """How bright the page is."""
    return sum(page.js("getComputedStyle(document.body).backgroundColor.match(/[0-9]+/g).map(Number)"))


def looks(browser, url):
    """On a screen, on a phone, and in the dark."""
    with Page(browser, url) as page:
        whole(page)
        expect(ground(page) > 600, "the page is dark without being asked")
    with Page(browser, url, dark=True) as page:
        whole(page)
        expect(ground(page) < 150, "the page is bright in the dark")
    with Page(browser, url, **PHONE) as page:
        whole(page)


def main():
    program, bryant, folder, *others = sys.argv[1:]
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)

    def run(*words):
        subprocess.run([bryant, *words], check=True, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        return f"file://{(folder / words[-1]).resolve()}"

    (folder / "study.yaml").write_text(STUDY)
    seat = run("run", "child-seat", "--no-files", "--report", "child-seat.html")
    frontal = run("run", "frontal", "--no-files", "--no-verify", "--report", "frontal.html")
    study = run("sweep", "study.yaml", "--out", "rows", "--report", "study.html")
    with Browser(program) as browser:
        for url in [seat, frontal, study]:
            looks(browser, url)
            print(f"{Path(url).name}: whole on a screen, on a phone and in the dark")
        for other in others:
            with Page(browser, f"file://{Path(other).resolve()}") as page:
                whole(page)


main()
