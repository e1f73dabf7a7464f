# SPDX-License-Identifier: BSD-3-Clause
"""What every attack on a running lilod is made of, for the scripts beside this file."""
import ctypes
import os
import threading
import time

from lilod_world import Lilod, Vlp16

ATTACKS = []


def attack(function):
    """The function raises AssertionError when lilod is not what it must be."""
    ATTACKS.append(function)
    return function


def expect(holds, what):
    if not holds:
        raise AssertionError(what)


class Case:
    """A lilod, ended and looked at in the end."""

    def __init__(self, exit_code=0, **options):
        self.exit_code = exit_code
        self.lilod = Lilod(**options)
        self.sensors = []

    def sensor(self, **options):
        self.sensors.append(Vlp16(self.lilod.ports["data_port"], **options))
        return self.sensors[-1]

    def __enter__(self):
        expect(self.lilod.wait(lambda h: True), "it did not start: " + self.lilod.stderr())
        return self

    def __exit__(self, kind, *_):
        for sensor in self.sensors:
            sensor.close()
        try:
            code, took = self.lilod.stop()
            if kind is None:
                expect(code == self.exit_code, f"exit code {code}, expected {self.exit_code}: "
                                               f"{self.lilod.stderr()}")
                expect(took < 5.0, f"it took {took:.1f} s to stop: the unit grants 5")
        finally:
            self.lilod.close()

    def health(self, status=None, complaint=None, without=None, seconds=15):
        def good(h):
            return ((status is None or h["status"] == status)
                    and (complaint is None or any(complaint in c for c in h["complaints"]))
                    and (without is None or not any(without in c for c in h["complaints"])))
        good_one = self.lilod.wait(good, seconds)
        found = self.lilod.health
        expect(good_one, f"expected status {status}, complaint {complaint}, not {without}; found "
                         f"{found and (found['status'], found['complaints'])}")

    def metrics(self, expected, seconds=5):
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            found = self.lilod.metrics()
            if all(found.get(name) == value for name, value in expected.items()):
                return
            time.sleep(0.1)
        expect(False, f"expected {expected}, found "
                      f"{ {name: found.get(name) for name in expected} }")

    def journal(self, event, text="", after=None, seconds=5):
        """`after`: later than the first entry of that event."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            events = self.lilod.journal.events()
            first = events.index(after) if after in events else 0
            told = [e for e in self.lilod.journal.entries if e["EVENT"]][first:]
            if any(e["EVENT"] == event and text in e["MESSAGE"] for e in told):
                return
            time.sleep(0.1)
        expect(False, f"no entry {event} with \"{text}\": "
                      f"{[(e['EVENT'], e['MESSAGE']) for e in self.lilod.journal.entries]}")


def stop_thread(pid, name):
    """Stops one thread by ptrace; call the result to let it go."""
    libc = ctypes.CDLL(None, use_errno=True)
    libc.ptrace.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_void_p, ctypes.c_void_p]
    for task in os.listdir(f"/proc/{pid}/task"):
        if open(f"/proc/{pid}/task/{task}/comm").read().strip() == name:
            expect(libc.ptrace(0x4206, int(task), None, None) == 0, "ptrace is forbidden")  # SEIZE
            libc.ptrace(0x4207, int(task), None, None)  # INTERRUPT
            os.waitpid(int(task), 0x40000000)
            # Who traces a thread has to see its end, or that of the process is never over.
            threading.Thread(target=wait_quietly, args=(int(task),), daemon=True).start()
            return lambda: libc.ptrace(17, int(task), None, None)  # DETACH
    raise AssertionError(f"no thread {name}")


def wait_quietly(task):
    try:
        os.waitpid(task, 0x40000000)
    except ChildProcessError:
        pass
