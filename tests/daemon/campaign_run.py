# SPDX-License-Identifier: BSD-3-Clause
"""One scenario of tests/campaign: lilo sim, lilod, lilo replay, and what came of it."""

import bisect
import json
import math
import os
import pathlib
import socket
import subprocess
import tempfile
import threading
import time

import lilod_world

WORST_M, WORST_DEG = 1.0, 3.0


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Lilod:
    """The daemon, with us as its sink; every datagram is kept."""

    def __init__(self, root, folder, sensor, preset="release"):
        self.sink = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.sink.bind(("127.0.0.1", 0))
        self.sink.settimeout(0.2)
        self.data_port, self.position_port, self.query_port = (free_port() for _ in range(3))
        path = folder / "lilod.yaml"
        path.write_text(
            f"sensor: {sensor}\n"
            f"udp: {{bind_address: 127.0.0.1, data_port: {self.data_port},"
            f" position_port: {self.position_port}}}\n"
            f"publish: {{sinks: ['127.0.0.1:{self.sink.getsockname()[1]}']}}\n"
            f"subscribe: {{port: {self.query_port}}}\n")
        self.log = folder / "log"
        # What AddressSanitizer keeps of freed memory would look like growth.
        environment = {**os.environ, "ASAN_OPTIONS": "quarantine_size_mb=1:thread_local_quarantine_size_kb=64"}
        with open(self.log, "w") as log:
            self.process = subprocess.Popen([root / "build" / preset / "bin/lilod", "--config", path],
                                            stderr=log, env=environment)
        self.poses, self.health, self.done = [], None, False
        self.thread = threading.Thread(target=self.listen)
        self.thread.start()

    def listen(self):
        while not self.done:
            try:
                message = json.loads(self.sink.recv(2048))
            except socket.timeout:
                continue
            if "pose" in message:
                self.poses.append(message)
            elif "health" in message:
                self.health = message["health"]

    def wait_health(self, condition, seconds):
        """Until a health datagram from now on meets the condition."""
        self.health = None
        end = time.monotonic() + seconds
        while time.monotonic() < end and self.process.poll() is None:
            health = self.health
            if health is not None and condition(health):
                return health
            time.sleep(0.05)
        return None

    def stop(self):
        self.process.terminate()
        try:
            return self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
            return "hangs"
        finally:
            time.sleep(0.3)
            self.done = True
            self.thread.join()
            self.sink.close()


# Quaternions are x y z w.
def conjugate(q):
    return (-q[0], -q[1], -q[2], q[3])


def product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def rotated(q, v):
    return product(product(q, (*v, 0.0)), conjugate(q))[:3]


def between(a, b):
    """a^-1 b."""
    back = conjugate(a[1])
    return rotated(back, tuple(y - x for x, y in zip(a[0], b[0]))), product(back, b[1])


class Truth:
    def __init__(self, folder):
        rows = [tuple(map(float, text.split()))
                for text in (folder / "gt_dense.tum").read_text().splitlines() if text[0] != "#"]
        self.times = [row[0] for row in rows]
        self.poses = [(row[1:4], row[4:8]) for row in rows]
        self.ends = [float(text.split()[0])
                     for text in (folder / "gt_end.tum").read_text().splitlines() if text[0] != "#"]

    def at(self, t):
        """Between two samples 5 ms apart; None beyond the recording."""
        k = bisect.bisect_right(self.times, t)
        if not 0 < k < len(self.times):
            return None
        s = (t - self.times[k - 1]) / (self.times[k] - self.times[k - 1])
        (pa, qa), (pb, qb) = self.poses[k - 1], self.poses[k]
        sign = 1.0 if sum(x * y for x, y in zip(qa, qb)) > 0 else -1.0
        q = [(1 - s) * x + s * sign * y for x, y in zip(qa, qb)]
        norm = math.sqrt(sum(x * x for x in q))
        return tuple((1 - s) * x + s * y for x, y in zip(pa, pb)), tuple(x / norm for x in q)


def errors(poses, truth, offset):
    """Of every pose against its session's first that is valid: (m, deg). A start that was found to be
    wrong begins again, and then nobody knows where its first poses were: they are `initializing`."""
    out, session, first = [], None, None
    for t, position, orientation, status, its_session in poses:
        at = truth.at(t + offset)
        if at is None:
            if session is None:
                return None
            out.append((0.0, 0.0))
            continue
        if its_session != session and status == "initializing":
            out.append((0.0, 0.0))
            continue
        if its_session != session:
            session, first = its_session, (at, (position, orientation))
        move, turn = between(between(first[0], at), between(first[1], (position, orientation)))
        out.append((math.dist(move, (0, 0, 0)),
                    math.degrees(2 * math.atan2(math.dist(turn[:3], (0, 0, 0)), abs(turn[3])))))
    return out


def best_errors(poses, truth, gps):
    """Without GPS the clock of the stamps is not that of the truth: the first pose is that of one of
    the first revolutions, whichever fits best."""
    if gps:
        return errors(poses, truth, 0.0)
    found = [e for end in truth.ends[:6] if (e := errors(poses, truth, end - poses[0][0]))]
    return min(found, key=lambda e: sum(m for m, _ in e), default=None)


def unpacked(message):
    pose = message["pose"]
    stamp, p, q = pose["stamp"], pose["position"], pose["orientation"]
    return (stamp["sec"] + 1e-9 * stamp["nsec"], (p["x"], p["y"], p["z"]),
            (q["x"], q["y"], q["z"], q["w"]), pose["status"], message["session"])


def times_by_status(poses):
    """Seconds of each status, and the longest way back to `tracking`."""
    out = dict.fromkeys(("initializing", "tracking", "degraded", "lost"), 0.0)
    recovery, away_since = 0.0, None
    for (t0, *_), (t1, _, _, status, _) in zip(poses, poses[1:]):
        out[status] += t1 - t0
        if status == "tracking":
            if away_since is not None:
                recovery = max(recovery, t1 - away_since)
            away_since = None
        elif status != "initializing" and away_since is None:
            away_since = t0
    if away_since is not None:
        recovery = max(recovery, poses[-1][0] - away_since)
    return out, recovery


def silent_packets(meta, options):
    """Of those that meta.json counts as lost: never sent, because the sensor had no power. Whether
    lilod counts them depends on whether the sensor's clock went on, so both are right."""
    if "--restart-at-s" not in options:
        return 0
    gap_s = float(options[options.index("--restart-gap-s") + 1]) if "--restart-gap-s" in options else 1.5
    return round(gap_s * meta["packets_sent"] / meta["duration_s"])


def accounts(meta, health):
    """What does not add up. Losses at the very ends of a recording nobody can see."""
    bad, packets, scans = [], health["packets"], health["scans"]
    arrived = meta["packets_sent"] - meta["packets_lost"] + meta["duplicates"] + meta["garbage"]
    if packets["received"] + packets["malformed"] + packets["kernel_dropped"] != arrived:
        bad.append(f"{arrived} packets came, {packets['received'] + packets['malformed']} accounted for")
    lost = meta["packets_lost"]
    if all(abs(packets["lost"] - expected) > 2 for expected in (lost, lost - meta["silent"])):
        bad.append(f"{lost} packets lost, {packets['lost']} counted")
    if scans["complete"] + scans["partial"] != scans["processed"] + scans["dropped"]:
        bad.append("scans do not add up")
    if scans["processed"] != health["poses_sent"] + health["poses_not_sent"]:
        bad.append("poses do not add up")
    if packets["foreign"] != meta["foreign_sent"]:
        bad.append(f"{meta['foreign_sent']} packets of another sensor came, {packets['foreign']} counted")
    if packets["kernel_dropped"] or scans["dropped"]:
        bad.append(f"kernel dropped {packets['kernel_dropped']} packets, we {scans['dropped']} scans")
    return bad


class OtherSensors:
    """They send from addresses of their own while they live, once the one that is followed has begun."""

    def __init__(self, models, port):
        self.sensors = [lilod_world.Vlp16(port, f"127.0.0.{2 + k}", hdl64e=model == "hdl64e")
                        for k, model in enumerate(models)]
        self.timer = threading.Timer(1.0, lambda: [sensor.on() for sensor in self.sensors])
        self.timer.start()

    def stop(self):
        """How many packets they have sent."""
        self.timer.cancel()
        for sensor in self.sensors:
            sensor.close()
        return sum(sensor.sent for sensor in self.sensors)


def play(root, folder, meta, speed):
    sensor = "{model: auto}" if meta["sensor"].startswith("vlp") else \
        f"{{model: hdl64e, calibration_file: {folder}/calibration.yaml}}"
    lilod = Lilod(root, folder, sensor)
    health, replayed = None, None
    try:
        if lilod.wait_health(lambda h: True, 20) is None:
            return {"bad": ["lilod did not start: " + lilod.log.read_text()[-200:]]}
        others = OtherSensors(meta["others"], lilod.data_port)
        try:
            replayed = subprocess.run(
                [root / "build/release/bin/lilo", "replay", folder / "data.pcap", "--speed", str(speed),
                 "--data-port", str(lilod.data_port), "--position-port", str(lilod.position_port)],
                stdout=subprocess.DEVNULL, timeout=60 + 3 * meta["duration_s"] / speed, check=False)
        finally:
            meta["foreign_sent"] = others.stop()
        health = lilod.wait_health(lambda h: h["sensor_silent_s"] > 1.0, 15)
    except subprocess.TimeoutExpired:
        return {"bad": ["the replay hangs"]}
    finally:
        code = lilod.stop()
    if code != 0 or health is None or replayed.returncode != 0:
        return {"bad": [f"lilod ended with {code}: " + lilod.log.read_text()[-200:]]}
    return judged(meta, lilod, folder)


def judged(meta, lilod, folder):
    health = lilod.health  # the last words of lilod
    poses = [unpacked(message) for message in lilod.poses]
    bad = accounts(meta, health)
    if len(poses) < 2:
        return {"bad": bad + ["no poses"]}
    off = best_errors(poses, Truth(folder), meta["gps"])
    if off is None:
        return {"bad": bad + ["the first stamp lies outside of the recording"]}
    tracked = [e for e, pose in zip(off, poses) if pose[3] == "tracking"] or [(0.0, 0.0)]
    worst_m, worst_deg = (max(e[k] for e in tracked) for k in (0, 1))
    if worst_m > WORST_M or worst_deg > WORST_DEG:
        bad.append("tracking, but wrong")
    seconds, recovery = times_by_status(poses)
    out = {f"{status}_s": value for status, value in seconds.items()}
    out.update(bad=bad, recovery_s=recovery, worst_m=worst_m, worst_deg=worst_deg,
               received=health["packets"]["received"], lost=health["packets"]["lost"],
               scans=health["scans"]["complete"] + health["scans"]["partial"],
               poses=health["poses_sent"], late=health["scans"]["dropped"],
               kernel_dropped=health["packets"]["kernel_dropped"])
    return out


def run(root, options, speed):
    with tempfile.TemporaryDirectory(prefix="lilo_campaign_") as name:
        folder = pathlib.Path(name)
        simulated = [option for option in options if option[0] != "+"]
        made = subprocess.run([root / "build/release/bin/lilo", "sim", folder, "--quiet", *simulated],
                              stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, check=False)
        if made.returncode != 0:
            return {"options": options, "bad": ["lilo sim: " + made.stderr.strip()]}
        meta = json.loads((folder / "meta.json").read_text())
        meta["others"] = [option[1:] for option in options if option[0] == "+"]
        meta["silent"] = silent_packets(meta, options)
        if not meta["gps"]:
            speed = 1.0  # such stamps follow the computer's clock
        result = play(root, folder, meta, speed)
        if speed > 1 and (result.get("late") or result.get("kernel_dropped")):
            result = play(root, folder, meta, 1.0)
        return {"options": options, **result}
