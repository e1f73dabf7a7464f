#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""lilo view as its users have it: a headless Chromium before a live lilod and before recordings.
Screenshots of what it showed are left in the folder --out for somebody to look at. Exit code 77
where there is no Chromium or no capture."""

import argparse
import http.client
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile
import time
import unittest

import chromium
from programs import Lilod, Program, View
from web_socket import Refused, WebSocket

SKIPPED = 77
SLOW_S = 90  # drawing in software, beside whatever else the machine does
ARGS = None

LAST = """(() => { const f = lilo.store.last; return f && { session: f.session.id, seq: f.seq,
  position: f.position, rotation: f.rotation, frames: lilo.store.frames.length,
  points: f.session.map.count, sessions: lilo.store.sessions.length }; })()"""
# Where two points of the map, metres apart, are seen: from -1 to 1.
TWO_POINTS = """(() => { const m = lilo.scene.view.matrix, { positions, count } = lilo.store.last.session.map;
  const found = [];
  for (let n = 0; n < 3 * count && found.length < 2; n += 3) {
    const p = positions.subarray(n, n + 3);
    const at = (row) => m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
    const [x, y] = [at(0) / at(3), at(1) / at(3)];
    const far = found.every((f) => Math.hypot(f[2] - p[0], f[3] - p[1]) > 5);
    if (Math.abs(x) < 0.6 && Math.abs(y) < 0.6 && far) found.push([x, y, p[0], p[1]]);
  }
  return found.map(([x, y]) => [x, y]); })()"""
STATUS = "document.getElementById('status').dataset.status"
WORD = "document.getElementById('word').textContent"


def shot(browser, name, rests=True):
    """`rests`: the camera will; behind a sensor that moves it never does."""
    if rests:
        browser.run("lilo.settled()")
    browser.screenshot(ARGS.out / f"{name}.png")


class WithPrograms(unittest.TestCase):
    def setUp(self):
        self._folder = tempfile.TemporaryDirectory(prefix="lilo_view_")
        self.folder = pathlib.Path(self._folder.name)
        self.addCleanup(self._folder.cleanup)

    def keep(self, program):
        self.addCleanup(program.end)
        return program

    def lilod(self, more=""):
        return self.keep(Lilod(ARGS.bin, self.folder, more))

    def view(self, *arguments):
        return self.keep(View(ARGS.bin, *arguments))

    def browser(self, width=800, height=520, **options):
        browser = chromium.Chromium(width, height, **options)
        self.addCleanup(browser.close)
        return browser


class Live(WithPrograms):
    def test_shows_what_lilod_says(self):
        """The page before the daemon, the drive, the sensor unplugged, the daemon started anew."""
        lilod = self.lilod()
        view, browser = self.view("--daemon-port", lilod.port), self.browser()
        browser.open(view.url)
        browser.wait(f"window.lilo && lilo.source.view.answers && {WORD} === 'No poses'")
        # Without the picture at first: drawn in software on a busy machine, one takes seconds, and
        # the words do not wait for it.
        browser.run("lilo.scene.draw_ = lilo.scene.draw, lilo.scene.draw = () => {}, 0")
        replay = self.keep(lilod.replay(ARGS.capture))
        browser.wait(f"lilo.store.frames.length > 60 && {STATUS} === 'tracking'", SLOW_S)
        self.expect_status_to_change(browser, replay)
        browser.run("lilo.scene.draw = lilo.scene.draw_, 0")
        shot(browser, "unplugged")
        self.expect_last_pose(browser, lilod)
        before = browser.run(LAST)
        lilod.kill()
        browser.wait(f"{WORD} === 'No answer'")
        lilod.start()
        lilod.ask(query="hello")
        self.keep(lilod.replay(ARGS.capture))
        browser.wait("lilo.store.sessions.length === 2", SLOW_S)
        browser.wait(f"lilo.store.last.seq > 20 && {STATUS} === 'tracking'", SLOW_S)
        after = browser.run(LAST)
        self.assertNotEqual(before["session"], after["session"])
        browser.wait("document.getElementById('session').textContent.startsWith('2 of 2')")
        self.assertGreater(after["points"], 1000)
        shot(browser, "new_session", rests=False)
        self.assertEqual(browser.console, [])

    def expect_status_to_change(self, browser, replay):
        """Ten times a second the page says how it is; whenever it does, it calls nothing tracking
        that has been silent for a second. On a busy machine it says so less often."""
        browser.run(f"""window.said = []; new MutationObserver(() =>
          said.push([performance.now() - lilo.store.poseAt, {STATUS}]))
          .observe(document.getElementById('status'), {{ attributes: true }}); 0""")
        replay.end()
        browser.wait(f"{STATUS} !== 'tracking'")
        self.assertEqual(browser.run(WORD), "No poses")
        silences = [ms for ms, status in browser.run("said") if status == "tracking"]
        self.assertLess(max(silences, default=0), 1000)

    def expect_last_pose(self, browser, lilod):
        said = lilod.ask(query="pose")
        shown = browser.run(LAST)
        self.assertEqual((shown["session"], shown["seq"]), (said["session"], said["seq"]))
        position, rotation = said["pose"]["position"], said["pose"]["orientation"]
        self.assertEqual(shown["position"], [position[k] for k in "xyz"])
        self.assertEqual(shown["rotation"], [rotation[k] for k in "xyzw"])
        drawn = browser.run("""(() => { const d = lilo.scene.drawn, n = 4 * (d.frames - 1);
          return [...d.trackArray.slice(n, n + 3)]; })()""")
        for wanted, got in zip(shown["position"], drawn):
            self.assertAlmostEqual(wanted, got, delta=1e-4)

    def test_later_browsers_see_the_past(self):
        lilod = self.lilod()
        view = self.view("--daemon-port", lilod.port)
        replay = self.keep(lilod.replay(ARGS.capture, "--speed", 2))
        first = self.browser(400, 300)
        first.open(view.url)
        first.wait("window.lilo && lilo.store.frames.length > 50", SLOW_S)
        replay.end()
        second = self.browser(400, 300)
        second.open(view.url)
        for browser in (first, second):
            browser.wait(f"window.lilo && lilo.store.frames.length > 50 && "
                         f"lilo.store.last.seq === {lilod.ask(query='pose')['seq']}", SLOW_S)
        self.assertEqual(first.run(LAST), second.run(LAST))

    def test_says_when_there_are_no_points(self):
        lilod = self.lilod(", points_clients: 0")
        view, browser = self.view("--daemon-port", lilod.port), self.browser(400, 300)
        self.keep(lilod.replay(ARGS.capture))
        browser.open(view.url)
        browser.wait("window.lilo && lilo.store.frames.length > 20", SLOW_S)
        browser.wait("document.getElementById('complaints').textContent.includes('no points')")
        self.assertEqual(browser.run("lilo.store.last.session.map.count"), 0)


class Recorded(WithPrograms):
    def paused(self, when):
        """A browser that stops playing the capture when `when` is true."""
        view, browser = self.view(ARGS.capture), self.browser()
        browser.open(view.url)
        browser.wait(f"window.lilo && {when}", SLOW_S)
        browser.press(" ")
        return browser

    def test_slider_pause_and_speed(self):
        browser = self.paused("lilo.source.view.done")
        browser.wait("!lilo.player.playing")
        frames = browser.run("lilo.store.frames.length")
        self.assertGreater(frames, 100)
        self.seek(browser, frames // 2)
        expected = browser.run(f"lilo.store.frames[{frames // 2}].position")
        shown = browser.run("document.getElementById('position').textContent")
        self.assertEqual(shown, "  ".join(f"{v:.2f}".replace("-0.00", "0.00") for v in expected) + " m")
        half = browser.run("document.getElementById('drawing').textContent")
        self.seek(browser, 0)
        self.assertNotEqual(half, browser.run("document.getElementById('drawing').textContent"))
        self.expect_to_play(browser)
        self.seek(browser, frames - 1)
        browser.press("f")
        shot(browser, "recording_fit")
        browser.press("t")
        browser.press("3")
        shot(browser, "recording_top_light")
        self.assertEqual(browser.console, [])

    def seek(self, browser, to):
        browser.wait(f"document.getElementById('slider').max >= {to}")
        browser.run(f"""(() => {{ const s = document.getElementById('slider'); s.value = {to};
          s.dispatchEvent(new Event('input')); }})()""")
        browser.wait(f"lilo.player.at === {to}")
        browser.run("lilo.settled()")

    def expect_to_play(self, browser):
        browser.run("document.getElementById('speed_factor').value = '5'")
        browser.run("document.getElementById('speed_factor').dispatchEvent(new Event('change'))")
        browser.press(" ")
        browser.wait("lilo.player.at > 10")
        browser.press(" ")
        stands = browser.run("lilo.player.at")
        time.sleep(0.5)
        self.assertEqual(browser.run("lilo.player.at"), stands)
        browser.press("ArrowRight")
        browser.wait(f"lilo.player.at === {stands + 1}")

    def test_measures_a_distance(self):
        browser = self.paused("lilo.store.frames.length > 100")
        browser.press("3")
        browser.run("lilo.settled()")
        browser.press("m")
        box = browser.run("""(() => { const b = document.getElementById('canvas').getBoundingClientRect();
          return [b.left, b.top, b.width, b.height]; })()""")
        for x, y in browser.run(TWO_POINTS):
            browser.click(box[0] + (x + 1) / 2 * box[2], box[1] + (1 - y) / 2 * box[3])
        browser.wait("lilo.measure.points.length === 2")
        a, b = browser.run("lilo.measure.points")
        length = sum((x - y) ** 2 for x, y in zip(a, b)) ** 0.5
        self.assertGreater(length, 1)
        shot(browser, "measure")
        browser.wait(f"document.getElementById('label').textContent.startsWith('{length:.2f} m')")

    def test_recorded_datagrams(self):
        lines = self.folder / "poses.jsonl"
        made = self.keep(Program([ARGS.bin / "lilo", "run", ARGS.capture, "--poses", lines],
                                 stdout=subprocess.DEVNULL))
        self.assertEqual(made.process.wait(120), 0)
        view, browser = self.view(lines), self.browser(390, 844)
        browser.open(view.url)
        browser.wait("window.lilo && lilo.source.view.done")
        last = json.loads(lines.read_text().splitlines()[-1])
        shown = browser.run(LAST)
        self.assertEqual(shown["seq"], last["seq"])
        self.assertEqual(shown["position"], [last["pose"]["position"][k] for k in "xyz"])
        shot(browser, "phone")

    def test_recorded_mcap(self):
        lilod, file = self.lilod(), self.folder / "drive.mcap"
        lilod.ask(query="hello")
        recorder = self.keep(Program([ARGS.bin / "lilo", "record", file, "--port", lilod.port, "--count", 40],
                                     stdout=subprocess.DEVNULL))
        self.keep(lilod.replay(ARGS.capture))
        self.assertEqual(recorder.process.wait(SLOW_S), 0)
        sent = [int(seq) for seq in re.findall(rb'"seq":(\d+),"pose":', file.read_bytes())]
        view, browser = self.view(file), self.browser(400, 300)
        browser.open(view.url)
        browser.wait("window.lilo && lilo.source.view.done", SLOW_S)
        self.assertEqual(browser.run("lilo.source.view.error || ''"), "")
        self.assertEqual(browser.run("lilo.store.frames.map((f) => f.seq)"), sent)
        self.assertEqual(len(sent), 40)

    def test_a_recording_that_cannot_be_read_says_why(self):
        file = self.folder / "cut.mcap"
        file.write_bytes(b"\x89MCAP0\r\n\x05")
        view, browser = self.view(file), self.browser(400, 300)
        browser.open(view.url)
        browser.wait("document.body?.innerText.includes('byte 8: ends early')")


class Access(WithPrograms):
    def setUp(self):
        super().setUp()
        self.lines = self.folder / "none.jsonl"
        self.lines.write_text("")

    def get(self, port, path="/", **headers):
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
        connection.request("GET", path, headers=headers)
        answer = connection.getresponse()
        answer.text = answer.read().decode()
        connection.close()
        return answer

    def test_other_sites_are_refused(self):
        port = self.view(self.lines).port
        self.assertEqual(self.get(port).status, 200)
        self.assertEqual(self.get(port, "/../../etc/passwd").status, 404)
        self.assertEqual(self.get(port, Host=f"evil.example:{port}").status, 403)
        ours = f"http://127.0.0.1:{port}"
        WebSocket(port, origin=ours).close()
        WebSocket(port).close()
        for origin in ("http://evil.example", f"https://127.0.0.1:{port}", "null", ours + ".evil"):
            with self.assertRaises(Refused, msg=origin) as caught:
                WebSocket(port, origin=origin)
            self.assertEqual(caught.exception.status, 403)
        WebSocket(port, origin="https://app.foxglove.dev", protocol="foxglove.websocket.v1").close()

    def test_beyond_loopback_a_link_works_once(self):
        view = self.view(self.lines, "--listen", "0.0.0.0")
        port, path = view.port, "/" + view.url.split("/", 3)[3]
        self.assertEqual(self.get(port).status, 403)
        with self.assertRaises(Refused):
            WebSocket(port)
        answer = self.get(port, path)
        self.assertEqual((answer.status, answer.getheader("Location")), (303, "/"))
        cookie = answer.getheader("Set-Cookie").split(";")[0]
        self.assertEqual(self.get(port, Cookie=cookie).status, 200)
        WebSocket(port, cookie=cookie).close()
        self.assertEqual(self.get(port, path).status, 403, "used up")
        self.assertNotEqual(view.next_link(), view.url, "another for the next browser")

    def test_commands_need_control_and_its_token(self):
        lilod = self.lilod()
        replay = self.keep(lilod.replay(ARGS.capture))
        while "pose" not in lilod.ask(query="pose"):
            time.sleep(0.1)
        replay.end()
        session = lilod.ask(query="hello")["session"]
        for view, token in ((self.view("--daemon-port", lilod.port), ""),
                            (self.view("--daemon-port", lilod.port, "--control"), "guessed")):
            socket = WebSocket(view.port)
            for wrong in (token, None, 5):
                socket.send(json.dumps({"token": wrong, "request": {"save": "trajectory"}}))
            socket.send("[" * 1000)
            self.addCleanup(socket.close)
        time.sleep(1)
        self.assertFalse((self.folder / "trajectory.tum").exists())
        token = view.url.split("#control=")[1]
        socket.send(json.dumps({"token": token, "request": {"save": "elsewhere"}}))
        socket.send(json.dumps({"token": token, "request": {"save": "trajectory"}}))
        deadline = time.monotonic() + 10
        while not (self.folder / "trajectory.tum").exists() and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertTrue((self.folder / "trajectory.tum").exists())
        self.assertEqual(lilod.ask(query="hello")["session"], session)


class Foxglove(WithPrograms):
    def test_sends_every_channel(self):
        lilod = self.lilod()
        view = self.view("--daemon-port", lilod.port)
        socket = WebSocket(view.port, path="/", protocol="foxglove.sdk.v1, foxglove.websocket.v1")
        self.addCleanup(socket.close)
        self.assertIn("Sec-WebSocket-Protocol: foxglove.", socket.head)
        self.assertEqual(json.loads(socket.receive()[1])["op"], "serverInfo")
        channels = {c["id"]: c for c in json.loads(socket.receive()[1])["channels"]}
        for channel in channels.values():
            self.assertEqual(json.loads(channel["schema"])["type"], "object")
        socket.send(json.dumps({"op": "subscribe", "subscriptions": [
            {"id": 100 + k, "channelId": k} for k in channels]}))
        self.keep(lilod.replay(ARGS.capture))
        seen = {}
        deadline = time.monotonic() + 60
        while len(seen) < len(channels) and time.monotonic() < deadline:
            is_binary, message = socket.receive()
            self.assertTrue(is_binary)
            op, subscription, stamp = struct.unpack("<BIQ", message[:13])
            self.assertEqual(op, 1)
            seen[channels[subscription - 100]["topic"]] = (stamp, json.loads(message[13:]))
        self.assertEqual(set(seen), {"/pose", "/tf", "/scan", "/map", "/health", "/lilo_pose"})
        cloud = seen["/scan"][1]
        self.assertEqual(cloud["frame_id"], "velodyne")
        self.assertEqual(len(cloud["data"]) * 3 // 4 % cloud["point_stride"], 0)
        transform = seen["/tf"][1]["transforms"][0]
        self.assertEqual((transform["parent_frame_id"], transform["child_frame_id"]), ("odom", "velodyne"))
        stamp = transform["timestamp"]
        self.assertEqual(seen["/tf"][0], stamp["sec"] * 10**9 + stamp["nsec"])


def main():
    global ARGS
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bin", type=pathlib.Path, required=True, help="folder of lilo and lilod")
    parser.add_argument("--capture", type=pathlib.Path, required=True, help="pcap of a VLP-16")
    parser.add_argument("--out", type=pathlib.Path, required=True, help="folder of the screenshots")
    ARGS, rest = parser.parse_known_args()
    if chromium.find() is None:
        print("skipped: no Chromium (apt-get install chromium)")
        return SKIPPED
    if not ARGS.capture.exists():
        print(f"skipped: no capture {ARGS.capture}")
        return SKIPPED
    ARGS.out.mkdir(parents=True, exist_ok=True)
    result = unittest.main(argv=[sys.argv[0], *rest], exit=False, verbosity=2, warnings="ignore").result
    return 0 if result.wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
