# SPDX-License-Identifier: BSD-3-Clause
"""A lilod and all it talks to, for the scripts beside this file: sensors, systemd's journal, a sink."""
import glob
import json
import math
import os
import random
import re
import shutil
import signal
import socket
import struct
import subprocess
import tempfile
import threading
import time

REPOSITORY = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


def binary(name):
    """LILO_BIN_DIR, or the release build."""
    return os.path.join(os.environ.get("LILO_BIN_DIR", REPOSITORY + "/build/release/bin"), name)


def preloaded(name):
    """What lets a lilod load tests/daemon/NAME.cpp before the C library."""
    folder = os.environ.get("LILO_TESTS_DIR", REPOSITORY + "/build/release/tests")
    return {"LD_PRELOAD": f"{folder}/lib{name}.so"}


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def event_names():
    """MESSAGE_ID -> name, of daemon/event.hpp."""
    text = open(REPOSITORY + "/daemon/event.hpp").read()
    names = re.findall(r"^  (\w+),$", text[text.index("enum class Event"):], re.M)
    return dict(zip(re.findall(r"\"([0-9a-f]{32})\"", text), names))


class Vlp16:
    """A VLP-16 at 600 rpm, 1.8 m above the floor of a scene, at sensor speed, on a thread of its own
    (63-9243, section 9). Range noise is 1 cm, another in each of three revolutions."""

    PACKET_S = 24 * 55.296e-6
    ELEVATIONS = [-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15]
    SCENES = {  # distance of the wall at an azimuth (rad), m
        "room": lambda a: min(12 / max(abs(math.cos(a)), 1e-9), 7 / max(abs(math.sin(a)), 1e-9)),
        "corridor": lambda a: 2 / max(abs(math.sin(a)), 1e-9),
        "field": lambda a: math.inf,  # the floor alone
        "fog": lambda a: None,        # no return at all
    }
    NOISES = 3
    _blocks = {}  # (scene, noise, upside_down) -> blocks by tenth of a degree

    def __init__(self, port, address="127.0.0.1", source_port=0, to="127.0.0.1", product=0x22,
                 hdl64e=False, scenes=("room",), upside_down=False):
        """With another product byte or the block flags of an HDL-64E it says it is another model.
        `scenes`: what it may have to show, the first at once."""
        self.port, self.product, self.to, self.hdl64e = port, product, to, hdl64e
        self.frozen_azimuth = self.frozen_stamp = False
        self.upside_down = upside_down
        for scene in scenes:
            self._prepare(scene, upside_down)
        self.show(scenes[0])
        self.loss = 0.0
        self.sent = 0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_BROADCAST, 1)
        self._socket.bind((address, source_port))
        self._on = threading.Event()
        self._end = False
        self._debt = 0.0
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def on(self):
        self._on.set()

    def off(self):
        self._on.clear()

    def close(self):
        self._end = True
        self._on.set()
        self._thread.join()
        self._socket.close()

    def show(self, scene):
        """What stands around it from now on."""
        self.scene = scene

    @classmethod
    def _prepare(cls, scene, upside_down):
        wall, rng = cls.SCENES[scene], random.Random(1)
        for noise in range(cls.NOISES):
            if (scene, noise, upside_down) not in cls._blocks:
                cls._blocks[scene, noise, upside_down] = [
                    cls._block(wall(math.radians(tenth / 10)), rng, upside_down) for tenth in range(3600)]

    @classmethod
    def _block(cls, wall, rng, upside_down):
        """The 32 returns of a block."""
        returns = b""
        for elevation in cls.ELEVATIONS:
            e = math.radians(-elevation if upside_down else elevation)
            reach = 0.0 if wall is None else wall / math.cos(e)
            if e < 0:
                reach = min(reach, 1.8 / math.sin(-e))
            steps = int((reach + rng.gauss(0.0, 0.01)) * 500) if 0.0 < reach <= 100.0 else 0
            returns += struct.pack("<HB", steps, 60)
        return returns * 2

    def packet(self, number):
        time_s = number * self.PACKET_S
        blocks, out = self._blocks[self.scene, int(time_s * 10) % self.NOISES, self.upside_down], []
        # Every packet begins at half a step of 0.01 degrees: one that began below 0.06 would have 437
        # steps from its first block to its last instead of 438, and tell 599 rpm.
        first = 0.5 if self.frozen_azimuth else int(time_s * 10 % 1 * 36000) + 0.5
        per_block = 0.0 if self.frozen_azimuth else 2 * 55.296e-6 * 10 * 36000
        for block in range(12):
            azimuth = int(first + block * per_block) % 36000
            flag = 0xddff if self.hdl64e and block % 2 else 0xeeff
            out.append(struct.pack("<HH", flag, azimuth) + blocks[azimuth // 10])
        stamp = 0 if self.frozen_stamp else int(time_s * 1e6) % 3600000000
        return b"".join(out) + struct.pack("<IBB", stamp, 0x37, self.product)

    def _run(self):
        number, began = 0, None
        while not self._end:
            if not self._on.is_set():
                began = None
                self._on.wait()
                continue
            now = time.monotonic()
            if began is None or now - began - number * self.PACKET_S > 0.5:
                began, number = now - number * self.PACKET_S, number
            while number * self.PACKET_S <= now - began:
                self._debt += self.loss
                if self._debt >= 1.0:
                    self._debt -= 1.0
                else:
                    self._socket.sendto(self.packet(number), (self.to, self.port))
                    self.sent += 1
                number += 1
            time.sleep(0.004)


class Journal:
    """journald's socket, for one daemon."""

    def __init__(self, folder):
        self.path = folder + "/journal"
        self.entries = []
        self._names = event_names()
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.bind(self.path)
        self._socket.setblocking(False)

    def read(self):
        """The entries since the last call, as dicts with EVENT beside MESSAGE_ID."""
        new = []
        while True:
            try:
                data = self._socket.recv(65536)
            except BlockingIOError:
                break
            entry = dict(line.split("=", 1) for line in data.decode().splitlines())
            entry["EVENT"] = self._names.get(entry.get("MESSAGE_ID"), "")
            new.append(entry)
        self.entries += new
        return new

    def events(self):
        self.read()
        return [entry["EVENT"] for entry in self.entries if entry["EVENT"]]

    def close(self):
        self._socket.close()


class Lilod:
    """A lilod with a folder of its own. `yaml` may hold {data_port}, {position_port}, {sink},
    {request_port}, {folder}; without it: a daemon on loopback."""

    YAML = """sensor:
  model: {model}
udp:
  bind_address: 127.0.0.1
  data_port: {data_port}
  position_port: {position_port}
publish:
  sinks: ["127.0.0.1:{sink}"]
subscribe:
  port: {request_port}
health:
  metrics_file: {folder}/lilo.prom
"""

    def __init__(self, yaml=None, name="lilod", more="", model="auto", environment=None, variables=None, **ports):
        """`environment` as it is; of `variables`, {folder} is put in."""
        self.folder = tempfile.mkdtemp(prefix="lilo_world_")
        self.sink = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.sink.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4 << 20)
        self.sink.bind(("127.0.0.1", 0))
        self.sink.setblocking(False)
        self.ports = {"data_port": free_port(), "position_port": free_port(),
                      "request_port": free_port(), **ports}
        fields = {**self.ports, "sink": self.sink.getsockname()[1], "folder": self.folder,
                  "model": model}
        self.config = f"{self.folder}/{name}.yaml"
        self.metrics_file = f"{self.folder}/lilo.prom"
        with open(self.config, "w") as file:
            file.write((yaml or self.YAML).format(**fields) + more.format(**fields))
        self.journal = Journal(self.folder)
        self.health = None
        self.poses = []
        self._errors = open(self.folder + "/stderr", "w")
        self.process = subprocess.Popen(
            [binary("lilod"), "--config", self.config], stderr=self._errors,
            env={**os.environ, "LILO_JOURNAL_SOCKET": self.journal.path, **(environment or {}),
                 **{key: text.format(**fields) for key, text in (variables or {}).items()}})

    def listen(self):
        """Reads what it has sent; `health` is the last, `poses` all."""
        while True:
            try:
                message = json.loads(self.sink.recv(4096))
            except BlockingIOError:
                return
            if "health" in message:
                self.health = {**message["health"], "session": message["session"]}
            if "pose" in message:
                self.poses.append(message)

    def wait(self, good, seconds=15):
        """Until a health is good(); whether one was."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            self.listen()
            if self.health is not None and good(self.health):
                return True
            time.sleep(0.05)
        return False

    def wait_for_poses(self, good, count, seconds=15):
        """Until so many more poses were good(); whether they came."""
        known, end = len(self.poses), time.monotonic() + seconds
        while time.monotonic() < end:
            self.listen()
            if sum(good(message["pose"]) for message in self.poses[known:]) >= count:
                return True
            time.sleep(0.01)
        return False

    def metrics(self):
        """Name with labels -> value."""
        try:
            lines = open(self.metrics_file).read().splitlines()
        except FileNotFoundError:
            return {}
        return {line.rsplit(" ", 1)[0]: float(line.rsplit(" ", 1)[1])
                for line in lines if not line.startswith("#")}

    def ask(self, request, seconds=3):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
            client.settimeout(seconds)
            client.sendto(json.dumps(request).encode(), ("127.0.0.1", self.ports["request_port"]))
            try:
                return json.loads(client.recv(4096))
            except socket.timeout:
                return None

    def status(self):
        """Exit code of `lilo status` and what it prints."""
        done = subprocess.run([binary("lilo"), "status", "--port", str(self.ports["request_port"])],
                              capture_output=True, text=True, timeout=10)
        return done.returncode, done.stdout

    def cpu_s(self):
        """Of all its threads."""
        fields = open(f"/proc/{self.process.pid}/stat").read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def stderr(self):
        return open(self.folder + "/stderr").read()

    def stop(self, seconds=10):
        """SIGTERM; the exit code and how long it took."""
        began = time.monotonic()
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGTERM)
        try:
            code = self.process.wait(seconds)
        except subprocess.TimeoutExpired:
            code = None
        took = time.monotonic() - began
        self.listen()
        self.journal.read()
        return code, took

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        self.sink.close()
        self.journal.close()
        self._errors.close()
        shutil.rmtree(self.folder, ignore_errors=True)
