"""Opens reports in Chromium as people do, and looks at what they show.

    reports.py CHROMIUM BRYANT FOLDER [REPORT.html …]

Other reports are only opened.
"""

import json
import re
import subprocess
import sys
from pathlib import Path

from chromium import Browser, Failure, Page

PHONE = {"size": (390, 844), "touch": True}
FALL = """\
model: fall
dimension: 3
systems:
  - { name: one, elements: [{ name: rod, mass: 2 kg, cg: [0, 0, 0], inertia: [0.1, 0.2, 0.3] }], start: { rates: { rod: [1, 2, 3] } } }
forces: [{ field: earth, acceleration: [0, 0, -1e-3] }]
run: { duration: 20 s, every: 100 ms }
"""
STUDY = """\
model: child-restraint
design: latin hypercube
runs: 40
parameters: { harness_slack: { from: 0 mm, to: 60 mm }, padding: { normal: { mean: 1, deviation: 0.2 }, min: 0.3, max: 2 } }
responses: [{ criterion: all }]
tables: [csv]
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


def number(text):
    """A number as the page writes it, and half a unit of its last digit."""
    text = text.replace("−", "-")
    mantissa, _, power = text.partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(text), 0.5 * 10.0 ** (int(power or 0) - decimals)


def same(text, value, what):
    """A text of four digits or more is this value, of which the page has six."""
    read, half = number(text)
    if abs(value) < 1e-12:
        value = 0
    # trailing zeros are not written, so that the last digit may stand further to the right than it seems
    half = min(half, 0.5e-3 * abs(value)) if value else half
    expect(abs(read - value) <= 1.01 * half + 1e-5 * abs(value), f"{what}: the page says {text}, the run {value}")


def people(unit):
    """A unit as people write it."""
    return unit.replace("^2", "²").replace("^3", "³").replace("*", "·")


def looks(browser, url):
    """On a screen, on a phone, and in the dark."""
    with Page(browser, url) as page:
        whole(page)
        expect(ground(page) > 600, "the page is dark without being asked")
        order = page.js("[...document.querySelectorAll('main h2')].map((e) => e.textContent)")
        expect(order[0] in ["Result", "Modes"] and order[-1] == "To make it again", order)
    with Page(browser, url, dark=True) as page:
        whole(page)
        expect(ground(page) < 150, "the page is bright in the dark")
        paper = page.js("paper(true); [getComputedStyle(document.body).backgroundColor, getComputedStyle(document.querySelector('canvas')).width]")
        expect(paper[0] == "rgb(255, 255, 255)", f"paper is {paper[0]}")
    with Page(browser, url, **PHONE) as page:
        whole(page)
        fingers(page)


def fingers(page):
    """Whatever can be pressed is as large as a finger: 40 px, which a label around it may have."""
    small = page.js("""[...document.querySelectorAll('button, select, summary, input, a')].filter((e) => e.offsetParent !== null).map((e) => {
        const r = (e.closest('label') || e).getBoundingClientRect(); return [e.id || e.textContent || e.ariaLabel, r.width, r.height];
    }).filter(([, width, height]) => Math.min(width, height) < 40)""")
    expect(not small, f"too small for a finger: {small[:5]}")


def scrolls(browser, url):
    """A thumb that begins on the motion or on a plot goes on down the page."""
    with Page(browser, url, **PHONE) as page:
        for canvas in ["byId('scene')", "plots[0].canvas"]:
            left, top, width, height = page.box(canvas)
            before = page.js("scrollY")
            page.swipe(left + width / 2, top + height / 2, 0, -200)
            page.wait(f"scrollY > {before} + 100")
        # one that stays, or goes across a plot, reads it
        left, top, width, height = page.box("plots[1].canvas")
        for dx in [0, 60]:
            page.swipe(left + 0.4 * width, top + height / 2, dx, 0)
            read = page.js("[plots[1].reading.hidden, plots[1].reading.querySelectorAll('output').length, pointed, plots[1].reading.getBoundingClientRect().right <= innerWidth]")
            expect(read[:2] == [False, 2] and read[3], f"a finger reads {read}")
        expect(page.js("zoomed === null"), "a finger zooms where it should read")
        # one that goes across the motion turns the view, or moves it
        left, top, width, height = page.box("byId('scene')")
        view = "JSON.stringify([camera.yaw, camera.center])"
        before = page.js(view)
        page.swipe(left + 50, top + height / 2, 150, 0)
        expect(page.js(view) != before, "a finger does not turn the view")


def keys(browser, url):
    """Every control is reached by the key Tab, and is seen to be."""
    with Page(browser, url, still=True) as page:
        wanted = page.js("""(window.seen = new Set(), [...document.querySelectorAll('button, select, summary, input, canvas[tabindex], a')].filter((e) => e.checkVisibility()).length)""")
        for _ in range(wanted + 5):
            page.key("Tab")
            faint = page.js("""(() => { const e = document.activeElement; if (e === document.body) return null; seen.add(e);
                return parseFloat(getComputedStyle(e).outlineWidth) >= 1 && getComputedStyle(e).outlineStyle !== 'none' ? null : e.outerHTML; })()""")
            expect(faint is None, f"nobody sees that this has the focus: {faint}")
        reached = page.js("seen.size")
        expect(reached == wanted, f"{reached} of {wanted} controls are reached")
        if not page.js("byId('scene') !== null"):
            return
        # the motion by keys
        page.js("byId('scene').focus()")
        page.key("End")
        expect(page.js("now === times[times.length - 1]"), "the key End does not lead to the end")
        page.key("ArrowLeft")
        expect(page.js("Math.abs(now - times[times.length - 2]) < 1e-9"), "an arrow does not lead to the row before")


def readings(browser, url, run):
    """Rows and peaks under the mouse are those of the run, with their units."""
    names = [column["name"] for column in run["columns"]]
    with Page(browser, url) as page:
        count = page.js("plots.length")
        expect(count > 1 and page.js("Math.max(...plots.map((plot) => plot.members.length))") <= 6, "a plot has more than six curves")
        shown = [name for plot in range(count) for name in page.js(f"plots[{plot}].members.map((m) => m.name)")]
        expect(sorted(shown) == sorted(names[1:]), f"the plots show {shown}")

        def under(plot, t):
            left, top, _, height = page.box(f"plots[{plot}].canvas")
            page.hover(left + page.js(f"plots[{plot}].canvas.places.x({t})"), top + 0.4 * height)
            time, *rest = page.js(f"[...plots[{plot}].reading.querySelectorAll('b, span, output')].map((e) => e.textContent)")
            return float(time.split()[0]), {name: (value, unit) for name, value, unit in zip(rest[::3], rest[1::3], rest[2::3])}

        for plot in range(count):
            for row in run["rows"][3 :: len(run["rows"]) // 3]:
                time, found = under(plot, row[0])
                expect(abs(time - 1e3 * row[0]) < 1e-6, f"{time} ms under the mouse, where the row is at {row[0]} s")
                expect(found, "nothing is read")
                for name, (value, unit) in found.items():
                    index = names.index(name)
                    same(value, row[index], f"{name} at {time} ms")
                    expect(unit == people(run["columns"][index]["unit"]), f"{name} is in {unit}")
        expect(run["peaks"], "the run has no peaks")
        for peak in run["peaks"]:
            plot = next(plot for plot in range(count) if peak["output"] in page.js(f"plots[{plot}].members.map((m) => m.name)"))
            time, found = under(plot, peak["time_s"])
            # samples of peaks are a fifth of a row apart
            expect(abs(time - 1e3 * peak["time_s"]) < 1e3 * run["rows"][1][0] / 4, f"the peak of {peak['output']} is read at {time} ms")
            same(found[peak["output"]][0], peak["value"], f"the peak of {peak['output']}")
        # energies: together they are what was given
        left, top, width, height = page.box("document.querySelector('[aria-label^=energy]')")
        page.hover(left + 0.6 * width, top + 0.5 * height)
        told = page.js("[...document.querySelectorAll('#verdict .reading output')].map((e) => e.textContent)")
        t = page.js("Number(document.querySelector('#verdict .reading b').textContent.split(' ')[0]) / 1000")
        given = page.js(f"data.energy.kinetic_at_start + data.works.effects.reduce((sum, e) => sum + Math.max(0, valueAt({{ times: data.works.times, values: e.values }}, {t})), 0)")
        expect(len(told) > 2 and abs(sum(number(text)[0] for text in told) - given) < 2e-3 * given, f"{told} is not {given} J")
        whole(page)


def colour(page, plot, member):
    """How many points of a plot have the colour of a curve."""
    return page.js(f"""(() => {{
        const {{ canvas, members }} = plots[{plot}], c = members[{member}].colour, [r, g, b] = [1, 3, 5].map((k) => parseInt(c.slice(k, k + 2), 16));
        const points = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;
        let count = 0;
        for (let k = 0; k < points.length; k += 4) count += Math.abs(points[k] - r) + Math.abs(points[k + 1] - g) + Math.abs(points[k + 2] - b) < 12;
        return count;
    }})()""")


def legend(browser, url):
    """A name hides its curve, and shows it again; names, values and units are apart."""
    with Page(browser, url) as page:
        page.box("plots[0].canvas")
        before = colour(page, 0, 1)
        expect(before > 50, f"the second curve has {before} points")
        key = "plots[0].box.querySelectorAll('.keys button')[1]"
        page.press(key)
        expect(colour(page, 0, 1) == 0, "a hidden curve is seen")
        expect(page.js(f"{key}.getAttribute('aria-pressed')") == "false", "a hidden curve is told as shown")
        page.press(key)
        expect(colour(page, 0, 1) == before, "a curve does not come back")
        places = page.js(f"[...{key}.children].map((e) => {{ const r = e.getBoundingClientRect(); return [r.left, r.right]; }})")
        expect(all(a[1] + 3 < b[0] for a, b in zip(places, places[1:])), f"name and value run together: {places}")
        # a part of the time, and all of it again
        left, top, width, height = page.box("plots[0].canvas")
        page.mouse("mouseMoved", left + 0.4 * width, top + 0.5 * height)
        page.mouse("mousePressed", left + 0.4 * width, top + 0.5 * height, button="left", buttons=1, clickCount=1)
        page.mouse("mouseMoved", left + 0.7 * width, top + 0.5 * height, button="left", buttons=1)
        page.mouse("mouseReleased", left + 0.7 * width, top + 0.5 * height, button="left", clickCount=1)
        page.settle()
        share = page.js("(zoomed[1] - zoomed[0]) / (clock[clock.length - 1] - clock[0])")
        expect(0.2 < share < 0.5, f"{share} of the time is shown")
        page.press("byId('whole')")
        expect(page.js("zoomed === null"), "all of the time is not shown again")
        whole(page)


def parts(browser, url, run):
    """The tree hides parts, and a click on a body tells its outputs."""
    row = run["rows"][37]
    names = [column["name"] for column in run["columns"]]
    with Page(browser, f"{url}#t={1e3 * row[0]}") as page:
        picture = "(render(), byId('scene').toDataURL())"
        index = "scene.bodies.findIndex((body) => body.name === 'child/{}')"
        head, torso = page.js(index.format("head")), page.js(index.format("torso"))
        box = f"document.querySelector('[data-part=\"{head}\"]').parentElement.querySelector('input')"
        page.press("byId('show-forces')")
        left, top, width, height = page.box("byId('scene')")

        def middle(body):
            """Where the middle of a body's first ellipsoid is on the canvas."""
            return page.js(f"""(() => {{
                const {{ frames }} = framesAt(now), e = scene.ellipsoids.find((one) => one.body === {body}), [x, y] = camera.seen(pointOf(frames, e.body, e.at));
                return [{width} / 2 + x * {height} / 2, {height} / 2 - y * {height} / 2];
            }})()""")

        x, y = middle(head)
        # beside the bones, which are drawn over ellipsoids
        dot = f"""(() => {{
            render();
            const c = document.createElement('canvas').getContext('2d');
            c.drawImage(byId('scene'), -{x} + 12, -{y} - 12);
            return [...c.getImageData(0, 0, 1, 1).data].join();
        }})()"""
        before, solid = page.js(picture), page.js(dot)
        page.press(box)
        expect(page.js(picture) != before and page.js(dot) != solid, "a hidden part is still drawn")
        page.press(box)
        expect(page.js(picture) == before and page.js(dot) == solid, "a part does not come back")
        left, top, width, height = page.box("byId('scene')")
        for part, place in [(torso, middle(torso)), (None, [width - 8, 8])]:
            page.click(left + place[0], top + place[1])
            found = page.js("chosenPart")
            expect(found == part, f"a click on {part} chooses {found}")
        page.click(left + x, top + y)
        told = page.js("[...byId('about').querySelectorAll('h3, td')].map((e) => e.textContent)")
        expect(told and told[0] == "child/head", f"a click on the head says {told}")
        for name in ["res. head acceleration", "head excursion", "head accelerometer"]:
            at = told.index(name)
            same(told[at + 1], row[names.index(name)], name)
            expect(told[at + 2] == people(run["columns"][names.index(name)]["unit"]), f"{name} is in {told[at + 2]}")
        expect(page.js(picture) != before, "the chosen part is not marked")
        page.press("[...byId('about').querySelectorAll('button')].find((e) => e.textContent === 'head excursion')")
        page.wait("document.activeElement.ariaLabel.includes('head excursion') && document.activeElement.getBoundingClientRect().top > 0 && document.activeElement.getBoundingClientRect().bottom < innerHeight")
        left, top, width, height = page.box("byId('scene')")
        page.click(left + x, top + y)
        expect(page.js("chosenPart") is None, "a second click does not let go")
        # a hidden part is not found, and what is behind it is
        page.press(box)
        page.box("byId('scene')")
        page.click(left + x, top + y)
        expect(page.js("chosenPart") != head, "a hidden part is chosen")
        # numbers beside arrows
        page.press("byId('show-forces')")
        count = "(() => { const c = byId('labels'); return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.reduce((n, v) => n + (v > 0), 0); })()"
        numbers = page.js(f"(render(), {count})")
        page.press("byId('show-numbers')")
        expect(page.js(f"(render(), {count})") < numbers, "forces have no numbers")
        whole(page)


def limits(browser, url):
    """Limits stand there as the regulation prints them."""
    with Page(browser, url) as page:
        cells = page.js("[...byId('result').querySelectorAll('td')].map((e) => e.textContent)")
        for name, limit in [("femur left", "10008"), ("neck tension", "4170"), ("HIC15", "700")]:
            expect(cells[cells.index(name) + 2] == limit, f"the limit of {name} is {cells[cells.index(name) + 2]}")


def opened(browser, url):
    """A report that is only looked at."""
    with Page(browser, url) as page:
        whole(page)


def failed(browser, url):
    """A run that broke off is told so, and its rows are shown."""
    with Page(browser, url) as page:
        whole(page)
        expect("failed" in page.js("byId('state').textContent"), "nothing is said of the failure")
        expect(page.js("plots.length") > 1 and "rows" in page.js("byId('verdict').textContent"), "there are no rows")
        page.press("plots[0].canvas")
        expect(not page.js("plots[0].reading.hidden"), "a row is not read")


def long(browser, url):
    """Times of a long run are in seconds, and a run without outputs has no plots."""
    with Page(browser, f"{url}#t=15000") as page:
        whole(page)
        expect(page.js("byId('clock').textContent") == "15.000 s", page.js("byId('clock').textContent"))
        expect(page.js("document.querySelector('.curves').hidden"), "there are curves of nothing")


def plain(program, url):
    """Where there is no WebGL, the motion is drawn, and parts are found."""
    with Browser(program, "--disable-3d-apis") as browser, Page(browser, url) as page:
        whole(page)
        expect(page.js("renderer instanceof Plain"), "there is WebGL")
        coloured = page.js("(() => { const c = byId('scene'); return c.getContext('2d').getImageData(0, 0, c.width, c.height).data.filter((v, k) => k % 4 === 3 && v > 0).length; })()")
        expect(coloured > 1000, "nothing is drawn")


def others(browser, url, second, row):
    """A second run and a test lie over the curves, and are read with them."""
    with Page(browser, url) as page:
        plot = page.js("plots.findIndex((plot) => plot.members.some((m) => m.name === 'res. head acceleration'))")
        left, top, _, height = page.box(f"plots[{plot}].canvas")
        page.hover(left + page.js(f"plots[{plot}].canvas.places.x({row[0]})"), top + 0.4 * height)
        told = page.js(f"[...plots[{plot}].reading.querySelectorAll('span, output')].map((e) => e.textContent)")
        for name, value in [("measured", row[3]), ("lap_slack=0 mm", second["rows"][37][3])]:
            full = f"res. head acceleration, {name}"
            expect(full in told, f"{full} is not in {told}")
            read, half = number(told[told.index(full) + 1])
            expect(abs(read - value) < max(half, 1e-3 * abs(value)), f"{full}: {read} for {value}")
        expect(page.js("!byId('beside').hidden"), "the second run cannot be hidden")
        picture = "(render(), byId('scene').toDataURL())"
        before = page.js(picture)
        page.press("byId('show-beside')")
        expect(page.js(picture) != before, "the second run is not drawn")
        whole(page)


def study(browser, url, results):
    """What a study gave stands at the top, without empty columns and in the units of its text; a run is read under the mouse, and its command is shown."""
    with Page(browser, url) as page:
        empty = page.js("""[...document.querySelectorAll('#result-heading ~ * table')].flatMap((table) => [...table.tHead.rows[0].cells]
            .filter((head, k) => head.textContent !== 'unit' && [...table.tBodies[0].rows].every((row) => !row.cells[k].textContent)).map((head) => head.textContent))""")
        expect(not empty, f"empty columns: {empty}")
        varied = page.js("[...byId('run').querySelectorAll('td')].map((e) => e.textContent)")
        expect(varied[:3] == ["harness_slack", "0 to 60", "mm"], f"what was varied is {varied}")
        lines = results.read_text().splitlines()
        heads = [head.strip('"').partition(" [")[0] for head in lines[0].split(",")]
        rows = [dict(zip(heads, line.split(","))) for line in lines[1:]]
        limit = page.js("data.responses.find((one) => one.name === 'head excursion').limit")
        expect(limit == 550, f"the limit of the excursion is {limit}")
        keep = sum(float(row["head excursion"]) <= 0.55 and float(row["chest 3 ms"]) <= 55 * 9.80665 for row in rows)
        verdict = page.js("byId('kept').textContent")
        expect(verdict.startswith(f"{keep} of {len(rows)} runs "), f"{keep} runs keep the limits; the page says {verdict}")
        table, again = [page.js(f"document.getElementById('{heading}').getBoundingClientRect().top") for heading in ["rows-heading", "again-heading"]]
        expect(again - table < 150, f"the table is {again - table} px long")
        # a run under the mouse
        left, top, _, _ = page.box("byId('scatter')")
        x, y = page.js("[byId('scatter').places.x(runs[7].values[0]), byId('scatter').places.y(runs[7].values[Number(byId('up').value)])]")
        page.hover(left + x, top + y)
        told = page.js("[...byId('reading').querySelectorAll('b, span, output')].map((e) => e.textContent)")
        index = int(told[0].split()[1])
        expect(index == 7, f"run {index} is read where run 7 is")
        for name, scale, unit in [("harness_slack", 1e-3, "mm"), ("padding", 1, ""), ("HIC15", 1, ""), ("head excursion", 1e-3, "mm"), ("head 3 ms", 9.80665, "g")]:
            at = told.index(name)
            same(told[at + 1], float(rows[index][name]) / scale, name)
            expect(told[at + 2] == unit, f"{name} is in {told[at + 2]}")
        # a histogram reads its bars: all of them together are all runs
        left, top, width, height = page.box("document.querySelector('#curves canvas')")
        bars, told = 0, set()
        for share in range(1, 200):
            page.hover(left + width * share / 200, top + height / 2)
            line = page.js("[...document.querySelectorAll('#curves .reading')[0].querySelectorAll('b, output')].map((e) => e.textContent)")
            if not page.js("document.querySelectorAll('#curves .reading')[0].hidden") and line[0] not in told:
                told.add(line[0])
                bars += int(line[1])
        expect(bars == len(rows), f"the bars have {bars} of {len(rows)} runs")
        left, top, _, _ = page.box("byId('scatter')")
        page.click(left + x, top + y)
        command = page.js("byId('command').textContent")
        # commands take SI
        expect(f"--set harness_slack={float(rows[index]['harness_slack'])}" in command, command)
        # the table, unfolded, has all runs
        page.press("byId('rows-title')")
        expect(page.js("document.querySelectorAll('#rows tbody tr').length") == len(rows), "the table has not all runs")
        whole(page)


def modes(browser, url):
    """A mode is chosen by a click and by keys, moves by itself unless motion is unwelcome, and the bars go with it."""
    picture = "(render(), byId('scene').toDataURL())"
    with Page(browser, url) as page:
        whole(page)
        expect(page.js("playing"), "the mode does not move")
        page.press("byId('play')")
        expect(not page.js("playing"), "the motion does not stop")
        page.js("setTime(0)")
        first = page.js(picture)
        chosen = "[...byId('modes').querySelectorAll('tbody tr')].map((row) => row.className + row.querySelector('button').ariaPressed)"
        last = page.js("data.modes.length") - 1
        row = "byId('modes').querySelectorAll('tbody tr')[{}].querySelector('button')"
        page.press(row.format(last))
        page.js("setTime(0)")
        expect(page.js("chosenMode") == last and page.js(chosen)[last] == "chosentrue", "a click does not choose a mode")
        expect(page.js(picture) != first, "another mode looks the same")
        page.key("ArrowUp")
        expect(page.js("chosenMode") == last - 1 and page.js("document.activeElement.textContent") == str(last), "a key does not choose a mode")
        # poses of the page are what is drawn: those at the beginning of a mode that swings are farthest from those after half a period
        page.js("chooseMode(data.modes.findIndex((mode) => mode.course === 'oscillates'))")
        told = page.js("byId('drawn').textContent")
        expect("mm from rest" in told and "Hz" in told, told)
        far = page.js("Math.max(...scene.frames[0].map((x, i) => Math.abs(x - scene.frames[(times.length - 1) / 2][i])))")
        expect(far > 1e-2, f"the ends of a mode are {far} m apart")
        bars = "[...byId('shape').querySelectorAll('.swing i')].map((e) => e.getBoundingClientRect().width)"
        page.js("setTime(0)")
        wide = page.js(bars)
        page.js("setTime(0.25)")
        expect(wide[0] > 5 and page.js(bars)[0] < 1, f"the bars do not swing: {wide}")
        before = page.js(picture)
        page.press("byId('show-beside')")
        expect(page.js(picture) != before, "the ends of the motion are not drawn")
        # on paper they always are
        page.press("byId('show-beside')")
        printed = page.js(f"(paper(true), {picture})")
        page.js("byId('show-beside').checked = true")
        both = page.js(f"(repaint(), {picture})")
        expect(printed == both, "on paper the ends of the motion are left out")
        page.js("paper(false)")
        whole(page)
    with Page(browser, url, still=True) as page:
        whole(page)
        expect(not page.js("playing") and page.js("byId('show-beside').checked"), "the page moves although motion is unwelcome")
        still = page.js("now")
        page.settle()
        expect(page.js("now") == still, "the page moves although motion is unwelcome")


def starts(browser, url):
    """The address says which mode is first."""
    with Page(browser, f"{url}#mode=2") as page:
        expect(page.js("chosenMode") == 1, "another mode is first than that of the address")


def printed(browser, url, most):
    """A report fits on this many pages of A4 and of letter paper, in the dark, too."""
    for dark in [False, True]:
        with Page(browser, url, dark=dark) as page:
            for paper in [(8.27, 11.69), (8.5, 11)]:
                count = pages(page.pdf(paper))
                expect(1 <= count <= most, f"{count} pages of {paper} inches")
            page.js("paper(true)")
            across = page.js("[document.body.scrollWidth, document.body.clientWidth, ...[...document.querySelectorAll('.wide')].map((e) => e.scrollWidth - e.clientWidth)]")
            expect(across[0] <= across[1] and max(across[2:]) <= 0, f"the page is wider than paper: {across}")
            drawn = [colour(page, plot, 0) for plot in range(page.js("typeof plots === 'undefined' ? 0 : plots.length"))]
            expect(min(drawn, default=100) > 20, f"curves are not drawn on paper: {drawn}")
            page.js("paper(false)")
            expect(page.js("!printing && !document.documentElement.classList.contains('print')"), "the page stays as on paper")
            whole(page)


def main():
    program, bryant, folder, *more = sys.argv[1:]
    bryant, folder = Path(bryant).resolve(), Path(folder)
    folder.mkdir(parents=True, exist_ok=True)

    def run(*words, code=0):
        done = subprocess.run([bryant, *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        expect(done.returncode == code, f"{words}: exit code {done.returncode}: {done.stderr}")
        return f"file://{(folder / words[-1]).resolve()}"

    def table(*words):
        return json.loads(subprocess.run([bryant, "run", *words, "--no-files", "--json"], check=True, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout)

    (folder / "study.yaml").write_text(STUDY)
    seat = run("run", "child-seat", "--no-files", "--report", "child-seat.html")
    frontal = run("run", "frontal", "--no-files", "--no-verify", "--report", "frontal.html")
    many = run("sweep", "study.yaml", "--out", "rows", "--report", "study.html")
    rows, second = table("child-seat"), table("child-seat", "--set", "lap_slack=0 mm")
    # a test in other units, as often as it is read here
    head = [f"{row[0]},{row[3] / 9.80665}" for row in rows["rows"]]
    (folder / "test.csv").write_text("\n".join(["time [s],head [g]", *head]))
    laid = run("run", "child-seat", "--no-files", "--beside", "lap_slack=0 mm", "--measured", "test.csv", "--channel", "res. head acceleration=head", "--report", "laid.html")
    (folder / "fall.yaml").write_text(FALL)
    fall = run("run", "fall.yaml", "--no-files", "--report", "fall.html")
    broken = run("run", "child-seat", "--no-files", "--max-steps", "200", "--report", "broken.html", code=3)
    run("settle", "robot-arm", "--force", "-o", "rest.json")
    ring = run("modes", "robot-arm", "--start", "rest.json", "--report", "modes.html")
    checks = [
        (failed, broken),
        (long, fall),
        *[(looks, url) for url in [seat, frontal, laid, many, ring]],
        *[(printed, url, 2) for url in [seat, frontal, many, ring]],
        *[(keys, url) for url in [seat, many, ring]],
        (scrolls, seat),
        (limits, frontal),
        (modes, ring),
        (starts, ring),
        (readings, seat, rows),
        (legend, seat),
        (parts, seat, rows),
        (study, many, folder / "rows/results.csv"),
        (others, laid, second, rows["rows"][37]),
        *[(opened, f"file://{Path(other).resolve()}") for other in more],
    ]
    wrong = []
    with Browser(program) as browser:
        for check, url, *about in checks:
            what = f"{check.__name__} of {Path(url).name}"
            try:
                check(browser, url, *about)
                print(what)
            except (AssertionError, Failure) as error:
                wrong.append(f"{what}: {error}")
                print(f"FAILED {wrong[-1]}")
    plain(program, seat)
    sys.exit(bool(wrong))


main()
