"""A run with the live page, and a WebSocket client of it. Python's standard library alone."""
import base64
import json
import os
import re
import socket
import struct
import subprocess


def short_scenario(root, folder, timeout_s, name="short"):
    """A hall without movers; the goal is 3 m ahead of the start."""
    text = open(os.path.join(root, "hal/sim/scenarios/crossing.toml")).read()
    text = re.sub(r"count = \d+", "count = 0", text.replace("../maps", os.path.join(os.path.abspath(root), "hal/sim/maps")))
    text = re.sub(r"timeout_s = .*", f"timeout_s = {timeout_s}", text)
    path = os.path.join(folder, name + ".toml")
    open(path, "w").write(text)
    return path


class Run:
    """jaywalk sim with --view; `url` is the address that it printed."""

    def __init__(self, jaywalk, scenario, out, *options):
        command = [jaywalk, "sim", scenario, "--backend", "cpu", "--out", out, "--view", *options]
        self.program = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        line = self.program.stdout.readline()
        if not line.startswith("view: "):
            raise AssertionError(f"{command}: the first line is {line!r}")
        self.url = line.split()[1]
        self.port = int(re.search(r":(\d+)/", self.url).group(1))

    def wait(self, timeout_s=60):
        self.said = self.program.communicate(timeout=timeout_s)[0]
        return self.program.returncode


def http(port, path="/", **headers):
    """The whole answer to a GET, as text."""
    with socket.create_connection(("127.0.0.1", port), timeout=10) as link:
        given = {"Host": f"127.0.0.1:{port}", **{name.replace("_", "-"): value for name, value in headers.items()}}
        link.sendall(("GET " + path + " HTTP/1.1\r\n" + "".join(f"{n}: {v}\r\n" for n, v in given.items()) + "\r\n").encode())
        answer = b""
        while b"\r\n\r\n" not in answer or not answer.startswith(b"HTTP/1.1 101"):
            part = link.recv(65536)
            if not part:
                break
            answer += part
        return answer.decode(errors="replace")


class Client:
    """A WebSocket to the page's server."""

    def __init__(self, port, path="/ws"):
        self.link = socket.create_connection(("127.0.0.1", port), timeout=10)
        key = base64.b64encode(os.urandom(16)).decode()
        self.link.sendall((f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                           f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.file = self.link.makefile("rb")
        assert b"101" in self.file.readline()
        while self.file.readline() not in (b"\r\n", b""):
            pass

    def order(self, **order):
        payload, mask = json.dumps(order).encode(), os.urandom(4)
        assert len(payload) < 126
        masked = bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload))
        self.link.sendall(bytes([0x81, 0x80 | len(payload)]) + mask + masked)

    def message(self):
        """The next message; None at the connection's end."""
        head = self.file.read(2)
        if len(head) < 2 or head[0] != 0x81:
            return None
        length = head[1]
        if length == 126:
            length = struct.unpack(">H", self.file.read(2))[0]
        elif length == 127:
            length = struct.unpack(">Q", self.file.read(8))[0]
        return json.loads(self.file.read(length))

    def frame(self):
        """The next frame of a tick; None at the connection's end."""
        message = self.message()
        while message and message["kind"] != "frame":
            message = self.message()
        return message
