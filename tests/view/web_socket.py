# SPDX-License-Identifier: BSD-3-Clause
"""A WebSocket client (RFC 6455) for what a browser would not do."""

import base64
import os
import socket
import struct


class Refused(Exception):
    """The server's answer was not the upgrade; `status` is its code."""

    def __init__(self, status, headers):
        super().__init__(f"HTTP {status}")
        self.status, self.headers = status, headers


class WebSocket:
    def __init__(self, port, path="/stream", host=None, origin=None, protocol=None, cookie=None):
        self._socket = socket.create_connection(("127.0.0.1", port), timeout=10)
        lines = [f"GET {path} HTTP/1.1", f"Host: {host or f'127.0.0.1:{port}'}", "Upgrade: websocket",
                 "Connection: Upgrade", "Sec-WebSocket-Version: 13",
                 f"Sec-WebSocket-Key: {base64.b64encode(os.urandom(16)).decode()}"]
        lines += [f"{name}: {value}" for name, value in (
            ("Origin", origin), ("Sec-WebSocket-Protocol", protocol), ("Cookie", cookie)) if value]
        self._socket.sendall("\r\n".join(lines + ["", ""]).encode())
        self._rest = b""
        while b"\r\n\r\n" not in self._rest:
            self._rest += self._more()
        head, _, self._rest = self._rest.partition(b"\r\n\r\n")
        self.head = head.decode()
        status = int(self.head.split()[1])
        if status != 101:
            self._socket.close()
            raise Refused(status, self.head)

    def _more(self):
        data = self._socket.recv(1 << 16)
        if not data:
            raise ConnectionError("the server closed the connection")
        return data

    def _take(self, size):
        while len(self._rest) < size:
            self._rest += self._more()
        data, self._rest = self._rest[:size], self._rest[size:]
        return data

    def receive(self):
        """(is_binary, payload) of the next message."""
        payload, binary = b"", False
        while True:
            first, second = self._take(2)
            size = second & 127
            if size == 126:
                size = struct.unpack(">H", self._take(2))[0]
            elif size == 127:
                size = struct.unpack(">Q", self._take(8))[0]
            data = self._take(size)
            if first & 15 > 2:  # ping, pong, close
                continue
            binary = binary or first & 15 == 2
            payload += data
            if first & 128:
                return binary, payload

    def send(self, text):
        data = text.encode()
        mask = os.urandom(4)
        size = bytes([128 | len(data)]) if len(data) < 126 else bytes([254]) + struct.pack(">H", len(data))
        self._socket.sendall(b"\x81" + size + mask + bytes(b ^ mask[k % 4] for k, b in enumerate(data)))

    def close(self):
        self._socket.close()
