# SPDX-License-Identifier: BSD-3-Clause
"""Poses from lilod, in one file without dependencies. The protocol is lilod-protocol(7).

    from lilo_client import LiloClient
    for pose in LiloClient().poses():
        print(pose["status"], pose["position"]["x"], pose.get("covariance"))

A pose is the dict of the protocol: "covariance" (36 numbers) and "weak_directions" are there when
they are known.
"""
import json
import socket
import time

PROTOCOL_MAJOR = 2


class VersionError(Exception):
    """This lilod speaks another major version of the protocol: its names may mean other things."""


class Refused(Exception):
    """lilod answered a request with an error; the text is its reason."""


def covariance_in_parent_frame(pose):
    """The pose's 6x6 covariance, row-major, about the axes of the parent frame, as ROS has it."""
    x, y, z, w = (pose["orientation"][name] for name in "xyzw")
    rotation = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    c = pose["covariance"]

    def element(row, column):
        i, j, block = row % 3, column % 3, 18 * (row // 3) + 3 * (column // 3)
        return sum(rotation[i][k] * c[block + 6 * k + m] * rotation[j][m]
                   for k in range(3) for m in range(3))
    return [element(row, column) for row in range(6) for column in range(6)]


class LiloClient:
    """Subscribes to a lilod, keeps the lease and survives its restarts.

    `host` is a name, or an IPv4 or IPv6 address. Raises OSError when it is none.
    """

    def __init__(self, host="127.0.0.1", port=9871, ttl_s=5.0):
        self._ttl_s = ttl_s
        self._token = None
        self._session = None
        self._renew_at = 0.0
        family, kind, _, _, address = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        self._name = f"{host}:{port}"
        self._socket = socket.socket(family, kind)
        self._socket.connect(address)  # so that only the server's datagrams come in
        self.hello = None  # the last answer to a subscription
        self.why = None  # why messages() or poses() ended: one line for people

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def request(self, **request):
        """Sends any request: request(reset={}), request(query="health")."""
        if self._token:
            request["token"] = self._token
        try:
            # Until we have shown a token, lilod's answer is no longer than what we send.
            self._socket.send(json.dumps(request).encode().ljust(256))
        except OSError as error:
            self.why = _reason(error)  # the lease is asked for again

    def ask(self, timeout_s=2.0, **request):
        """Sends a request and returns what lilod answers: ask(reset={}), ask(save="map").

        Raises Refused when the answer is an error, TimeoutError when there is none.
        """
        kind = {"save": "done", "reset": "done"}.get(next(iter(request)), "hello")
        kind = request.get("query", kind)
        deadline = time.monotonic() + timeout_s
        self.request(**request)
        while time.monotonic() < deadline:
            message = self._receive(deadline)
            if message is None:
                continue
            if "token" in message.get("hello", {}):
                self.request(**request)
            elif kind in message:
                return message[kind]
            elif "error" in message:
                raise Refused(message["error"]["reason"])
        raise TimeoutError(f"lilod at {self._name}: {self.why or 'no answer'}")

    def messages(self, timeout_s=None):
        """Every datagram as a dict, for ever, or until none came for timeout_s; then `why` says
        why. Raises VersionError."""
        quiet_since = time.monotonic()
        self.why = None
        while True:
            deadline = None if timeout_s is None else quiet_since + timeout_s
            if deadline is not None and time.monotonic() >= deadline:
                self.why = f"nothing from lilod at {self._name} for {timeout_s:g} s: " \
                           f"{self.why or 'no answer'}"
                return
            self._renew()
            message = self._receive(deadline)
            if message is not None:
                quiet_since = time.monotonic()
                yield message

    def poses(self, timeout_s=None):
        """The poses alone, with session, seq and timestamp put in, for ever, or until none came for
        timeout_s; then `why` says why. Raises VersionError.

        "new_session" is true in the first pose and whenever the session is another than before: it
        has another origin, so compare it with no earlier pose."""
        last_pose = time.monotonic()
        for message in self.messages(timeout_s):
            if "pose" in message:
                head = {key: message[key] for key in ("timestamp", "session", "seq")}
                new = message["session"] != self._session
                self._session = message["session"]
                last_pose = time.monotonic()
                yield {**message["pose"], **head, "new_session": new}
            elif timeout_s is not None and time.monotonic() - last_pose >= timeout_s:
                self.why = f"no pose from lilod at {self._name} for {timeout_s:g} s: " \
                           f"{_gist(message)}"
                return

    def close(self):
        self.request(unsubscribe={})
        self._socket.close()

    def _receive(self, deadline):
        """The next datagram; None when there is none until `deadline` or the next renewal."""
        ends = [end for end in (deadline, self._renew_at) if end is not None]
        self._socket.settimeout(max(min(ends) - time.monotonic(), 0.001))
        try:
            message = json.loads(self._socket.recv(2048))
        except socket.timeout:
            return None
        except OSError as error:
            self.why = _reason(error)
            time.sleep(0.05)
            return None
        except ValueError:
            self.why = "what it sends is no JSON"
            return None
        if not isinstance(message, dict):
            self.why = "what it sends is no object"
            return None
        self._compare_version(message)
        self.why = _gist(message)
        self._take_hello(message.get("hello"))
        return message

    def _compare_version(self, message):
        version = str(message.get("v", "none"))
        if version.split(".")[0] != str(PROTOCOL_MAJOR):
            raise VersionError(f"lilod at {self._name} speaks protocol {version}, this client "
                               f"reads {PROTOCOL_MAJOR}.x")

    def _renew(self):
        if time.monotonic() >= self._renew_at:
            self._renew_at = time.monotonic() + min(1.0, self._ttl_s / 2)
            self.request(subscribe={"ttl_s": self._ttl_s})

    def _take_hello(self, hello):
        if hello is None:
            return
        self.hello = hello
        if "token" in hello:  # we are not on its computer: show that we got this
            self._token = hello["token"]
            self._renew_at = 0.0


def _reason(error):
    return "nobody listens there" if isinstance(error, ConnectionRefusedError) else str(error)


def _gist(message):
    if "error" in message:
        return "it refuses: " + message["error"]["reason"]
    if "health" in message:
        return "its health is " + message["health"]["status"]
    return "it has answered" if "hello" in message else None
