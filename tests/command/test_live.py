#!/usr/bin/env python3
"""cm1e trace --live: the page in headless Chromium, beside a running program and alone; who gets nothing; browsers that
are slow, stuck or too many. Skips the page without Chromium, all of it in a build that has no HTTP server.

test_live.py BIN-DIRECTORY OUTPUT-FOLDER
"""
import base64
import contextlib
import csv
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import browser  # noqa: E402
import control_bench as bench  # noqa: E402
from control_bench import CM1E, ENVIRONMENT, expect, path_of  # noqa: E402

OUTPUT = sys.argv[2]
SKIP = 77
BUS = """\
bus: {interface: sim, lost_cycles_limit: 50, cycle_time_us: %d}
axes:
  - {name: X, sim: {no_stops: true}}
  - {name: Y}
"""
ADDRESS = re.compile(r"http://127\.0\.0\.1:(\d+)/[0-9a-f]{32}/$")
ABOUT = "document.getElementById('about').textContent"
TAKEN = f"Number({ABOUT}.split(' ')[0])"


@contextlib.contextmanager
def moving(cycle_us=1000):
    """A program that turns X. It is not disturbed by anything here."""
    with bench.running(f"{cycle_us}.yaml") as program:
        yield program.process


@contextlib.contextmanager
def live(*words):
    """cm1e trace --live, and the address that it prints."""
    child = subprocess.Popen([CM1E, "trace", "--live", *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                             text=True, env=ENVIRONMENT)
    try:
        url = child.stdout.readline().strip()
        expect(ADDRESS.match(url), "the address", url)
        yield child, url
    finally:
        if child.poll() is None:
            child.kill()
        child.communicate()


def end_by_ctrl_c(child):
    child.send_signal(signal.SIGINT)
    out, err = child.communicate(timeout=20)
    expect(child.returncode == 0, "Ctrl-C", (child.returncode, out, err))
    return out, err


# ---- who gets nothing -----------------------------------------------------------------------------------------------

def status_of(url, method="GET", **headers):
    try:
        with urllib.request.urlopen(urllib.request.Request(url, method=method, headers=headers), timeout=5) as reply:
            return reply.status
    except urllib.error.HTTPError as error:
        return error.code


def check_protection():
    with moving() as process, live("--attach", str(process.pid)) as (child, url):
        port = int(ADDRESS.match(url).group(1))
        root = f"http://127.0.0.1:{port}/"
        expect(status_of(url) == 200, "the page itself")
        other = url[:-2] + ("1/" if url[-2] == "0" else "0/")
        for wrong in (root, root + "events", url[:-1], url[:-2] + "/", url + "x", other, other + "events",
                      root + "../" + url[len(root):]):
            expect(status_of(wrong) == 404, "an address without the token", wrong)
        for host in (f"evil.example:{port}", "127.0.0.1", f"localhost:{port}", f"127.0.0.1:{port + 1}", ""):
            expect(status_of(url, Host=host) in (400, 403), "a name that leads here (DNS rebinding)", host)
            expect(status_of(url + "events", Host=host) in (400, 403), "events for a name that leads here", host)
        for origin in ("http://evil.example", "null", f"https://127.0.0.1:{port}", f"http://127.0.0.1:{port}0"):
            expect(status_of(url + "events", Origin=origin) == 403, "a page from elsewhere", origin)
        for method in ("POST", "PUT", "OPTIONS", "DELETE"):
            expect(status_of(url, method) == 405, "only GET", method)
        with urllib.request.urlopen(url, timeout=5) as reply:
            policy = reply.headers["Content-Security-Policy"]
            expect("default-src 'none'" in policy and "frame-ancestors 'none'" in policy and
                   reply.headers["Referrer-Policy"] == "no-referrer" and
                   reply.headers["Cache-Control"] == "no-store" and
                   "Access-Control-Allow-Origin" not in reply.headers, "headers", reply.headers)
        others = [line.split()[3] for line in subprocess.run(["ss", "-ltnH"], capture_output=True, text=True,
                                                             check=False).stdout.splitlines()]
        expect(all(at == f"127.0.0.1:{port}" for at in others if at.endswith(f":{port}")), "only 127.0.0.1", others)
        check_many(url)
        with socket.create_connection(("127.0.0.1", port)) as half, \
                socket.create_connection(("127.0.0.1", port)) as junk:
            half.sendall(b"GET /")
            junk.sendall(b"\xff" * 200000)
            expect(status_of(url) == 200, "beside halves of requests and garbage")
        end_by_ctrl_c(child)
        told = subprocess.run([CM1E, "trace", "--attach", str(process.pid), "--live", "--json", "--for", "0.1"],
                              capture_output=True, text=True, timeout=20, env=ENVIRONMENT)
        first, _, rest = told.stdout.partition("\n")
        expect(told.returncode == 0 and ADDRESS.match(json.loads(first)["url"]) and json.loads(rest)["samples"] > 0,
               "the address is one line of JSON, the result another document", told)
        with socket.create_server(("127.0.0.1", 0)) as other:
            in_use = other.getsockname()[1]
            for words, why in ((["--live=0"], "port"), (["--live=65536"], "port"), (["--live=x"], "port"),
                               ([f"--live={in_use}"], "another one"), (["--live", "--list"], "choose one")):
                told = subprocess.run([CM1E, "trace", "--attach", str(process.pid), *words], capture_output=True,
                                      text=True, timeout=20, env=ENVIRONMENT)
                expect(told.returncode in (1, 2) and why in told.stderr, f"trace {words}", told)


def check_many(url):
    """More pages than there are places: the others go on, and a place is free again."""
    with contextlib.ExitStack() as stack:
        for _ in range(8):
            stack.enter_context(urllib.request.urlopen(url + "events", timeout=5))
        expect(status_of(url + "events") == 503, "a ninth page")
    end = time.monotonic() + 10
    while time.monotonic() < end and (status := try_events(url)) != 200:
        time.sleep(0.1)
    expect(status == 200, "a page after others have gone", status)


def try_events(url):
    try:
        with urllib.request.urlopen(url + "events", timeout=5) as reply:
            return reply.status
    except urllib.error.HTTPError as error:
        return error.code


# ---- slow and stuck browsers ----------------------------------------------------------------------------------------

def message_of(lines):
    """The next message of a stream of events: its number, and its samples; None: the stream has ended."""
    for line in lines:
        if line.startswith(b"data: {"):
            told = json.loads(line[6:])
            return told["number"], len(base64.b64decode(told["samples"])) // 8
    return None


def check_stuck():
    """One page does not read for longer than messages are kept; another one gets every sample meanwhile, and so does
    the file."""
    with moving(500) as process, live("--attach", str(process.pid), "--csv", path_of("stuck.csv")) as (child, url):
        port, path = ADDRESS.match(url).group(1), url[url.rindex(":") + 1:].split("/", 1)[1]
        stuck = socket.socket()
        stuck.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        stuck.connect(("127.0.0.1", int(port)))
        stuck.sendall(f"GET /{path}events HTTP/1.0\r\nHost: 127.0.0.1:{port}\r\n\r\n".encode())
        expected, end = 0, time.monotonic() + 12
        with urllib.request.urlopen(url + "events", timeout=5) as reply:
            while time.monotonic() < end:
                number, values = message_of(reply)
                expect(number == expected, "a page beside a stuck one", (number, expected))
                expected = number + values // 19  # time and 18 signals
        memory = resident_mib(child.pid)
        with stuck, stuck.makefile("rb") as reply:
            gaps, at = [], 0
            while (message := message_of(reply)) is not None and message[0] < expected:
                gaps.append(message[0] - at)
                at = message[0] + message[1] // 19
        expect(expected > 18000 and max(gaps) > 1000, "the stuck page finds that samples are gone", (expected, gaps))
        expect(memory < 200, "memory", memory)
        out, err = end_by_ctrl_c(child)
        expect("lost" not in err, "samples of the file are lost because of a page", err)
        with open(path_of("stuck.csv"), encoding="utf-8") as file:
            rows = sum(1 for _ in file) - 1
        expect(f"{rows} samples" in out and rows >= expected, "the file", (rows, expected, out))


def resident_mib(process):
    with open(f"/proc/{process}/status", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmRSS")) // 1024


# ---- the page -------------------------------------------------------------------------------------------------------

CELL = """(() => { let axis = "";
  for (const row of document.querySelectorAll("#values tr"))
    if (row.className === "group") axis = row.textContent;
    else if (axis + " " + row.cells[0].textContent.trim() === %s)
      return [...row.cells].slice(1).map(c => c.textContent);
})()"""


def cells(chromium, page, name):
    return chromium.run(page, CELL % json.dumps(name))


def press(chromium, page, key):
    chromium.run(page, "document.dispatchEvent("
                 f"new KeyboardEvent('keydown', {{key: {json.dumps(key)}, cancelable: true}}))")


def check_page():
    words = ["--csv", path_of("page.csv"), "--object", "X:0x603F"]
    with moving() as process, live("--attach", str(process.pid), *words) as (child, url), \
            browser.Browser() as chromium:
        page = chromium.open(url)
        expect(chromium.wait(page, f"document.body.dataset.ready && {TAKEN} > 1500"), "samples come",
               chromium.run(page, ABOUT))
        expect(chromium.run(page, "document.querySelectorAll('.chart').length") == 2 * 3 + 2, "charts")
        velocity = CELL % json.dumps("X actual velocity [u/s]")
        expect(chromium.wait(page, f"Math.abs(({velocity})[0] - 0.5) < 0.05"), "the velocity now",
               cells(chromium, page, "X actual velocity [u/s]"))
        before = float(cells(chromium, page, "X actual position [u]")[0])
        position = CELL % json.dumps("X actual position [u]")
        expect(chromium.wait(page, f"Number(({position})[0]) > {before + 0.3}"), "it moves")
        check_pause(chromium, page)
        check_width(chromium, page)
        os.kill(child.pid, signal.SIGSTOP)  # more than the page has, and less than the program keeps
        time.sleep(1)
        os.kill(child.pid, signal.SIGCONT)
        picture = chromium.ask("Page.captureScreenshot", page)["data"]
        os.makedirs(OUTPUT, exist_ok=True)
        with open(os.path.join(OUTPUT, "trace_live.png"), "wb") as file:
            file.write(base64.b64decode(picture))
        expect(len(picture) > 20000, "no picture of the page")
        end_by_ctrl_c(child)
        check_end(chromium, page)
        expect(chromium.errors == [], "errors of scripts", chromium.errors)


def check_pause(chromium, page):
    position = "X actual position [u]"
    press(chromium, page, " ")
    shown, taken = cells(chromium, page, position)[4:], chromium.run(page, TAKEN)
    expect(chromium.wait(page, f"{TAKEN} > {taken + 500}"), "samples come while the page stands")
    expect(cells(chromium, page, position)[4:] == shown and chromium.run(page, "run.textContent") == "Run",
           "the page stands", (shown, cells(chromium, page, position)))
    press(chromium, page, " ")
    expect(chromium.wait(page, f"({CELL % json.dumps(position)})[5] !== {json.dumps(shown[1])}"), "the page runs again")
    press(chromium, page, "+")
    expect(chromium.run(page, "run.textContent") == "Run", "zoom lets the page stand")
    press(chromium, page, "0")
    expect(chromium.run(page, "run.textContent") == "Pause", "0 lets it run")


def check_width(chromium, page):
    """Only the last second is shown: X has covered half a unit in it."""
    chromium.run(page, "(() => { width.value = '1'; width.dispatchEvent(new Event('change')); })()")
    range_of = CELL % json.dumps("X set position [u]")
    expect(chromium.wait(page, f"(c => Math.abs(c[5] - c[4] - 0.5) < 0.02)({range_of})"), "the time shown",
           cells(chromium, page, "X set position [u]"))


def check_end(chromium, page):
    """The page has all samples of the file, and says that no more come."""
    expect(chromium.wait(page, "document.body.dataset.ended"), "the page is told of the end")
    expect("was ended" in chromium.run(page, "connection.textContent"), "the text of the end",
           chromium.run(page, "connection.textContent"))
    press(chromium, page, "0")
    with open(path_of("page.csv"), newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file)
    expect(chromium.run(page, ABOUT).startswith(f"{len(rows)} samples of {len(head) - 1} signals") and
           "did not reach" not in chromium.run(page, ABOUT), "all samples", (chromium.run(page, ABOUT), len(rows)))
    low, high = (float(text) for text in cells(chromium, page, "X actual position [u]")[4:])
    values = [float(row[head.index("X actual position [u]")]) for row in rows]
    expect(abs(low - min(values)) < 1e-4 and abs(high - max(values)) < 1e-4, "the range of a signal",
           (low, high, min(values), max(values)))


def check_end_of_program():
    """The page is told that the program has ended."""
    with moving() as process, live("--attach", str(process.pid)) as (child, url), browser.Browser() as chromium:
        page = chromium.open(url)
        expect(chromium.wait(page, f"{TAKEN} > 500"), "samples come")
        process.terminate()
        expect(chromium.wait(page, "document.body.dataset.ended"), "the end of the program")
        expect("has ended" in chromium.run(page, "connection.textContent"), "the text",
               chromium.run(page, "connection.textContent"))
        process.wait(timeout=20)
        expect(child.wait(timeout=20) == 0, "exit status")


def check_alone():
    with live("-i", "sim", "--for", "2") as (child, url), browser.Browser() as chromium:
        page = chromium.open(url)
        expect(chromium.wait(page, f"{TAKEN} > 300"), "samples come")
        expect(chromium.wait(page, "document.body.dataset.ended") and
               "complete" in chromium.run(page, "connection.textContent"), "the end of a recording")
        expect(child.wait(timeout=20) == 0, "exit status")


def check_in_chromium():
    """One browser at a time: it takes a processor."""
    for check in (check_page, check_end_of_program, check_alone):
        bench.judge(check)


def main():
    told = subprocess.run([CM1E, "trace", "-i", "sim", "--live", "--for", "0.1"], capture_output=True, text=True,
                          timeout=60, env=ENVIRONMENT)
    if "libmicrohttpd" in told.stderr or "dygraphs" in told.stderr:
        expect(told.returncode == 1, "a build without", told)
        print("SKIPPED: this build serves no pages:", told.stderr)
        sys.exit(SKIP)
    for cycle_us in (500, 1000):
        bench.write(f"{cycle_us}.yaml", BUS % cycle_us)
    if browser.path():
        bench.run(check_in_chromium, check_stuck, check_protection)
    else:
        print("no Chromium here: the page is not opened")
        bench.run(check_stuck, check_protection)


if __name__ == "__main__":
    main()
