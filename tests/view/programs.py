# SPDX-License-Identifier: BSD-3-Clause
"""lilod, lilo view and lilo replay as the tests start them."""

import json
import os
import pathlib
import re
import select
import socket
import subprocess
import time


def free_port():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
        s.bind(("127.0.0.1", 0))
        return s.getsockname()[1]


class Program:
    """A program of ours, ended with the test."""

    def __init__(self, command, **options):
        self.process = subprocess.Popen([str(word) for word in command], **options)

    def end(self):
        if self.process.poll() is None:
            self.process.terminate()
            try:
                self.process.wait(10)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()

    def kill(self):
        self.process.kill()
        self.process.wait()

    def resident_mb(self):
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", status).group(1)) / 1024


class Lilod(Program):
    """On free ports of loopback."""

    def __init__(self, binaries, folder, more=""):
        self._binaries, self.folder = binaries, pathlib.Path(folder)
        self.data_port, self.position_port, self.port = free_port(), free_port(), free_port()
        self.config = self.folder / "lilod.yaml"
        self.config.write_text(
            f"sensor: {{model: vlp16}}\n"
            f"udp: {{bind_address: 127.0.0.1, data_port: {self.data_port},"
            f" position_port: {self.position_port}}}\n"
            f"subscribe: {{port: {self.port}{more}}}\nstate: {{directory: {self.folder}}}\n")
        self.start()

    def start(self):
        super().__init__([self._binaries / "lilod", "--config", self.config],
                         stderr=open(self.folder / "lilod.log", "a"))

    def ask(self, **request):
        """The answer to a request; tried until lilod is there."""
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:
            s.settimeout(0.5)
            s.connect(("127.0.0.1", self.port))
            for _ in range(40):
                try:
                    s.send(json.dumps(request).encode().ljust(256))
                    return json.loads(s.recv(2048))
                except OSError:
                    time.sleep(0.2)
        raise TimeoutError("lilod does not answer")

    def replay(self, capture, *more):
        return Program([self._binaries / "lilo", "replay", capture, "--data-port", self.data_port,
                        "--position-port", self.position_port, *more],
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


class View(Program):
    """`lilo view` on a free port; `url` is the link it printed."""

    def __init__(self, binaries, *arguments):
        super().__init__([binaries / "lilo", "view", "--port", 0, *arguments],
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.printed = ""
        self.url = self.next_link()

    def next_link(self, timeout_s=30):
        """The link printed next."""
        deadline, seen = time.monotonic() + timeout_s, len(self.printed)
        while time.monotonic() < deadline:
            found = re.search(r"http://\S+", self.printed[seen:])
            if found and "\n" in self.printed[seen + found.end():]:
                return found.group()
            if select.select([self.process.stdout], [], [], 0.2)[0]:
                more = os.read(self.process.stdout.fileno(), 4096).decode()
                if not more:
                    break
                self.printed += more
        raise TimeoutError(f"lilo view printed no link: {self.printed}")

    @property
    def port(self):
        return int(re.search(r":(\d+)/", self.url).group(1))
