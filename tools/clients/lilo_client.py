"""Poses from lilod, in one file without dependencies. The protocol is in daemon/PROTOCOL.md.

    from lilo_client import LiloClient
    for pose in LiloClient().poses():
        print(pose["status"], pose["position"]["x"], pose.get("covariance"))

A pose is the dict of the protocol: "covariance" (36 numbers) and "weak_directions" are there when
they are known.
"""
import json
import socket
import time


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
    """Subscribes to a lilod, keeps the lease and survives its restarts."""

    def __init__(self, host="127.0.0.1", port=9871, ttl_s=5.0):
        self._server = (host, port)
        self._ttl_s = ttl_s
        self._token = None
        self._renew_at = 0.0
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._socket.connect(self._server)  # so that only the server's datagrams come in
        self.hello = None  # the last answer to a subscription

    def request(self, **request):
        """Sends any request: request(reset={}), request(query="health")."""
        if self._token:
            request["token"] = self._token
        try:
            # Until we have shown a token, lilod's answer is no longer than what we send.
            self._socket.send(json.dumps(request).encode().ljust(256))
        except OSError:
            pass  # nobody listens yet: the lease is asked for again

    def messages(self, timeout_s=None):
        """Every datagram as a dict, for ever, or until none came for timeout_s."""
        quiet_since = time.monotonic()
        while timeout_s is None or time.monotonic() - quiet_since < timeout_s:
            self._renew()
            self._socket.settimeout(0.2)
            try:
                message = json.loads(self._socket.recv(2048))
            except (socket.timeout, OSError, ValueError):
                continue
            self._take_hello(message.get("hello"))
            quiet_since = time.monotonic()
            yield message

    def poses(self, timeout_s=None):
        """The poses alone, with session, seq and timestamp put in."""
        for message in self.messages(timeout_s):
            if "pose" in message:
                head = {key: message[key] for key in ("timestamp", "session", "seq")}
                yield {**message["pose"], **head}

    def close(self):
        self.request(unsubscribe={})
        self._socket.close()

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
