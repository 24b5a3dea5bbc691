"""The page of a trace in a real browser: it is opened in headless Chromium, and what a person would do is done to it
(pointer, cursors, zoom, keys). What it shows is compared with the CSV file of the same run. Skips without Chromium or
without dygraphs in the build.

Usage: test_page.py <folder of the binaries> <output folder> <source folder>
"""
import base64
import csv
import html
import json
import os
import re
import shutil
import struct
import subprocess
import sys

BIN, OUTPUT, SOURCE = sys.argv[1:4]
SKIP = 77

# Runs behind the page's own script; its result is the text of the element that is added at the end.
DRIVER = """
<script>
(function () {
  const result = {errors: window.pageErrors};
  const charts = [...document.querySelectorAll(".chart")];
  const cells = name => {
    let axis = "";
    for (const row of document.querySelectorAll("#values tr")) {
      if (row.className === "group")
        axis = row.textContent;
      else if ((axis === "signals" ? "" : axis + " ") + row.cells[0].textContent.trim() === name)
        return [...row.cells].slice(1).map(cell => cell.textContent);
    }
    throw new Error("no row " + name);
  };
  const names = () => [...document.querySelectorAll("#values tr")].map(row => row.cells[0].textContent.trim());
  const at = (chart, share, type, more) => {
    const canvas = chart.querySelectorAll("canvas")[1], box = canvas.getBoundingClientRect();
    const options = {bubbles: true, cancelable: true, view: window, button: 0, clientX: box.left + box.width * share,
                     clientY: box.top + box.height / 2, screenX: box.left + box.width * share, screenY: 10, ...more};
    canvas.dispatchEvent(type === "wheel" ? new WheelEvent(type, options) : new MouseEvent(type, options));
  };
  const click = (chart, share, shiftKey) => {
    at(chart, share, "mousemove", {});
    at(chart, share, "mousedown", {shiftKey});
    at(chart, share, "mouseup", {shiftKey});
  };
  const labels = () => [...charts[0].querySelectorAll(".dygraph-axis-label-y")].length;
  const times = () => [...document.querySelectorAll("#cursors td")].map(cell => cell.textContent);
  const key = name => document.dispatchEvent(new KeyboardEvent("keydown", {key: name, cancelable: true}));

  result.charts = charts.length;
  result.ready = document.body.dataset.ready;
  result.about = document.getElementById("about").textContent;
  result.names = names();
  result.axisLabels = labels();
  result.events = [...document.querySelectorAll("#events li")].map(item => item.textContent);
  result.whole = cells(PROBE);
  click(charts[0], 0.3, false);
  click(charts[0], 0.8, true);
  result.cursors = times();
  result.values = cells(PROBE);
  result.step = cells("step");
  result.state = cells(STATE);
  for (let i = 0; i < 12; i++)
    at(charts[1], 0.3, "wheel", {deltaY: -1});
  result.zoomed = cells(PROBE);
  key("0");
  result.unzoomed = cells(PROBE);
  for (let i = 0; i < 5; i++)
    key("+");
  key("ArrowRight");
  result.moved = cells(PROBE);
  at(charts[2], 0.5, "dblclick", {});
  result.all = cells(PROBE);
  document.querySelector("#events li").click();
  result.atEvent = times();
  result.nearEvent = cells(PROBE);
  key("Escape");
  result.noCursors = times();
  const box = document.querySelector("#values input");
  box.click();
  result.hidden = !box.checked;
  result.wide = document.documentElement.scrollWidth <= window.innerWidth;
  const text = document.createElement("pre");
  text.id = "result";
  text.textContent = JSON.stringify(result);
  document.body.append(text);
})();
</script>
"""
CATCH = "<script>window.pageErrors = []; window.addEventListener('error', e => pageErrors.push(String(e.message)));</script>"


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def browser():
    return next((path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))), None)


def in_browser(page, *arguments):
    done = subprocess.run([browser(), "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1500,1200",
                           "--virtual-time-budget=10000", *arguments, f"file://{page}"], capture_output=True, text=True,
                          timeout=240, check=False)
    expect(done.returncode == 0, f"the browser ended with {done.returncode}: {done.stderr[-500:]}")
    return done.stdout


def drive(page, probe, state):
    """What the page shows while it is used."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    expect("<script src" not in text and "http-equiv" not in text and "<link" not in text, "the page needs other files")
    driver = DRIVER.replace("PROBE", json.dumps(probe)).replace("STATE", json.dumps(state))
    driven = page.replace(".html", "_driven.html")
    with open(driven, "w", encoding="utf-8") as file:
        file.write(text.replace("<head>", "<head>" + CATCH, 1).replace("</body>", driver + "</body>"))
    dom = in_browser(driven, "--dump-dom")
    found = re.search(r'<pre id="result">(.*?)</pre>', dom, re.DOTALL)
    expect(found, f"the page did not run to its end: {dom[-300:]}")
    return json.loads(html.unescape(found.group(1)))


def run_example():
    page, table = os.path.join(OUTPUT, "trace_page.html"), os.path.join(OUTPUT, "trace_page.csv")
    bus = os.path.join(OUTPUT, "trace_page.yaml")
    with open(f"{SOURCE}/examples/three_axes.yaml", encoding="utf-8") as real, open(bus, "w", encoding="utf-8") as file:
        file.write(real.read().replace("bus:\n", "bus:\n  virtual_time: true\n", 1))
    subprocess.run([os.path.join(BIN, "03_plc_program"), "-b", bus, "--seconds", "9", "--html", page, "--csv", table],
                   check=True, stdout=subprocess.DEVNULL)
    with open(table, newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    return page, head, rows


def seconds(text):
    return float(re.search(r"(-?[\d.]+) s", text).group(1))


def close(text, value, tolerance):
    return abs(float(text) - value) <= tolerance


def check_values(shown, head, rows):
    """The values at both cursors and their range are those of the CSV file."""
    probe, step = head.index("X actual position [u]"), head.index("step")
    values = [float(row[probe]) for row in rows]
    at = []
    for text in shown["cursors"][1:3]:
        wanted = seconds(text)
        at.append(max(i for i, row in enumerate(rows) if float(row[0]) <= wanted + 1e-9))
    whole = 1e-4 * (max(values) - min(values))
    _, a, b, difference, low, high = shown["values"]
    expect(close(a, values[at[0]], whole) and close(b, values[at[1]], whole), f"values at cursors: {shown['values']}")
    expect(close(difference, values[at[1]] - values[at[0]], whole), f"difference: {shown['values']}")
    expect(close(low, min(values), whole) and close(high, max(values), whole), f"range: {shown['values']}")
    expect(shown["step"][1] == rows[at[0]][step], f"the step at cursor A: {shown['step']}")
    expect(shown["state"][1] == rows[at[0]][head.index("X state")], f"the state at cursor A: {shown['state']}")
    expect(abs(seconds(shown["cursors"][3]) - (float(rows[at[1]][0]) - float(rows[at[0]][0]))) < 2e-3,
           f"between cursors: {shown['cursors']}")


EXACT = """PROGRAM Main
VAR n : UDINT; big : LREAL := 123456789.125; single : REAL := 0.1; sum : LREAL := 0.1; END_VAR
n := n + 1;
IF n = 100 THEN big := 123456789.25; END_IF
sum := 0.1 + 0.2;
END_PROGRAM
"""


def check_variables():
    """Variables of a program are shown with all digits of their type, and written so."""
    source, page, table = (os.path.join(OUTPUT, f"exact.{ending}") for ending in ("st", "html", "csv"))
    bus = os.path.join(OUTPUT, "exact.yaml")
    with open(source, "w", encoding="utf-8") as file:
        file.write(EXACT)
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {interface: sim, virtual_time: true}\naxes: [{name: X, position: 1}]\n")
    cm1e = os.path.join(BIN, "cm1e")
    subprocess.run([cm1e, "st", "build", source, "-o", source + ".so"], check=True)
    subprocess.run([cm1e, "run", source + ".so", "-b", bus, "--seconds", "1", "--html", page, "--csv", table], check=True,
                   stdout=subprocess.DEVNULL)
    with open(page, encoding="utf-8") as file:
        text = file.read()
    driver = """<script>document.dispatchEvent(new KeyboardEvent("keydown", {key: "0"}));
const charts = [...document.querySelectorAll(".chart")];
const canvas = charts[0].querySelectorAll("canvas")[1], box = canvas.getBoundingClientRect();
canvas.dispatchEvent(new MouseEvent("mousemove", {bubbles: true, view: window, clientX: box.left + box.width * 0.7,
                                                  clientY: box.top + box.height / 2}));
const shown = {};
for (const row of document.querySelectorAll("#values tr"))
  if (row.cells.length > 1) shown[row.cells[0].textContent.trim()] = row.cells[1].textContent;
const told = document.createElement("pre");
told.id = "result"; told.textContent = JSON.stringify(shown); document.body.append(told);</script>"""
    driven = page.replace(".html", "_driven.html")
    with open(driven, "w", encoding="utf-8") as file:
        file.write(text.replace("</body>", driver + "</body>"))
    dom = in_browser(driven, "--dump-dom")
    shown = json.loads(html.unescape(re.search(r'<pre id="result">(.*?)</pre>', dom, re.DOTALL).group(1)))
    wanted = {"Main.big": "123456789.25", "Main.single": "0.1", "Main.sum": "0.30000000000000004"}
    expect({name: shown.get(name) for name in wanted} == wanted, f"variables on the page: {shown}")
    with open(table, newline="", encoding="utf-8") as file:
        last = list(csv.DictReader(file))[-1]
    expect(last["Main.big"] == "123456789.25" and last["Main.sum"] == "0.30000000000000004", f"variables in CSV: {last}")


def check_far_away():
    """An axis that is far from where it began, and slow: each sample of its position is another one on the page, as it is in
    the table."""
    page, table, bus = (os.path.join(OUTPUT, f"far.{ending}") for ending in ("html", "csv", "yaml"))
    with open(bus, "w", encoding="utf-8") as file:
        file.write("bus: {interface: sim, virtual_time: true}\naxes: [{name: X, position: 1, "
                   "sim: {no_stops: true}}]\n")
    subprocess.run([os.path.join(BIN, "cm1e"), "move", "-b", bus, "X", "--by", "234.56788", "-v", "20", "--html", page, "--csv",
                    table], check=True, stdout=subprocess.DEVNULL)
    with open(page, encoding="utf-8") as file:
        trace = re.search(r'"name": "X actual position"[^}]*"bytes": (\d), "base": ([^,]+), "data": "([^"]*)"', file.read())
    width, base, data = int(trace.group(1)), float(trace.group(2)), base64.b64decode(trace.group(3))
    kept = struct.unpack(f"<{len(data) // width}{'d' if width == 8 else 'f'}", data)
    values = [value if width == 8 else base + value for value in kept]
    with open(table, newline="", encoding="utf-8") as file:
        rows = [float(row["X actual position [u]"]) for row in csv.DictReader(file)]
    worst = max(abs(a - b) for a, b in zip(values, rows))
    expect(len(values) == len(rows) and rows[-1] > 200 and worst <= 1e-6, f"far away: {worst} u between page and table")
    driver = """<script>document.dispatchEvent(new KeyboardEvent("keydown", {key: "0"}));
const far = [...document.querySelectorAll("#values tr")]
  .filter(row => row.cells.length > 1 && row.cells[0].textContent.trim() === "set position [u]")
  .map(row => row.cells[6].textContent);
const told = document.createElement("pre");
told.id = "result"; told.textContent = JSON.stringify(far); document.body.append(told);</script>"""
    driven = page.replace(".html", "_driven.html")
    with open(page, encoding="utf-8") as file, open(driven, "w", encoding="utf-8") as out:
        out.write(file.read().replace("</body>", driver + "</body>"))
    dom = in_browser(driven, "--dump-dom")
    shown = html.unescape(re.search(r'<pre id="result">(.*?)</pre>', dom, re.DOTALL).group(1))
    expect("234.56788" in shown, f"far away: the page shows {shown}")


def check_page():
    page, head, rows = run_example()
    shown = drive(page, "X actual position [u]", "X state")
    expect(shown["errors"] == [], f"errors of scripts: {shown['errors']}")
    expect(shown["charts"] == 3 * 3 + 3 and shown["ready"] == str(shown["charts"]), f"{shown['charts']} charts")
    expect(f"{len(rows)} samples of {len(head) - 1} signals" in shown["about"], shown["about"])
    expect(shown["axisLabels"] > 1, "a chart without numbers at its axis")
    check_values(shown, head, rows)
    expect(shown["zoomed"] != shown["whole"] and shown["unzoomed"][4:] == shown["whole"][4:], "zoom by the wheel")
    expect(shown["moved"][4:] != shown["whole"][4:] and shown["all"][4:] == shown["whole"][4:], "zoom and move by keys")
    errors = [text for text in shown["events"] if "motor power is off" in text]
    expect(len(errors) == 1 and "Y error" in errors[0], f"events: {shown['events']}")
    expect(seconds(shown["atEvent"][1]) == seconds(shown["events"][0]), "a click on an event sets cursor A there")
    expect(shown["noCursors"][1:] == ["A: -", "B: -", "B - A: -"], f"Escape: {shown['noCursors']}")
    expect(shown["hidden"] and shown["wide"], "a hidden signal; or the page is wider than the window")
    picture = os.path.join(OUTPUT, "trace_page.png")
    in_browser(page, f"--screenshot={picture}")
    expect(os.path.getsize(picture) > 20000, "no picture of the page")


def main():
    os.makedirs(OUTPUT, exist_ok=True)
    tried = subprocess.run([os.path.join(BIN, "cm1e"), "move", "-i", "sim", "--by", "0.1", "--html",
                            os.path.join(OUTPUT, "move.html")], capture_output=True, text=True, check=False)
    if "without the chart library" in tried.stderr:
        print("SKIPPED: this build has no pages (libjs-dygraphs was missing)")
        sys.exit(SKIP)
    expect(tried.returncode == 0, tried.stderr)
    if not browser():
        print("SKIPPED: there is no Chromium here")
        sys.exit(SKIP)
    check_page()
    check_variables()
    check_far_away()


main()
