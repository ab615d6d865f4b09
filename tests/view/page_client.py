"""A run with the live page, and a WebSocket client of it. Python's standard library alone."""
import base64
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys

kHang_s = 600  # after which nothing is waited for any more: no verdict on slow machines


def check(is_so, claim):
    if not is_so:
        sys.exit("FAILED: " + claim)


def short_scenario(root, folder, timeout_s, name="short"):
    """A hall without movers; the goal is 3 m ahead of the start."""
    text = open(os.path.join(root, "hal/sim/scenarios/crossing.toml")).read()
    text = re.sub(r"count = \d+", "count = 0", text.replace("../maps", os.path.join(os.path.abspath(root), "hal/sim/maps")))
    text = re.sub(r"timeout_s = .*", f"timeout_s = {timeout_s}", text)
    path = os.path.join(folder, name + ".toml")
    open(path, "w").write(text)
    return path


class Run:
    """A jaywalk command with --view; `url` is the address that it printed."""

    def __init__(self, *command, port=None):
        self.program = subprocess.Popen([*command, "--view", *([str(port)] if port else [])], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        line = self.program.stdout.readline()
        if not line.startswith("view: "):
            raise AssertionError(f"{command}: the first line is {line!r}")
        self.url = line.split()[1]
        self.port = int(re.search(r":(\d+)/", self.url).group(1))

    def wait(self):
        self.said = self.program.communicate(timeout=kHang_s)[0]
        return self.program.returncode

    def kill(self):
        self.program.kill()
        self.wait()

    def interrupt(self):
        self.program.send_signal(signal.SIGINT)
        return self.wait()


def simulation(jaywalk, scenario, out, *options, port=None):
    return Run(jaywalk, "sim", scenario, "--backend", "cpu", "--out", out, *options, port=port)


def http(port, path="/", method="GET", patience_s=kHang_s, **headers):
    """The whole answer, as text."""
    with socket.create_connection(("127.0.0.1", port), timeout=patience_s) as link:
        upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": 13} if "Sec_WebSocket_Key" in headers else {}
        given = {"Host": f"127.0.0.1:{port}", **upgrade, **{name.replace("_", "-"): value for name, value in headers.items()}}
        link.sendall((f"{method} {path} HTTP/1.1\r\n" + "".join(f"{n}: {v}\r\n" for n, v in given.items()) + "\r\n").encode())
        answer = b""
        while b"\r\n\r\n" not in answer or not answer.startswith(b"HTTP/1.1 101"):
            part = link.recv(65536)
            if not part:
                break
            answer += part
        return answer.decode(errors="replace")


class Client:
    """A WebSocket to the page's server; `protocol`: the subprotocols that it offers."""

    def __init__(self, port, path="/ws", protocol=None):
        self.link = socket.create_connection(("127.0.0.1", port), timeout=kHang_s)
        key = base64.b64encode(os.urandom(16)).decode()
        offer = f"Sec-WebSocket-Protocol: {protocol}\r\n" if protocol else ""
        self.link.sendall((f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
                           f"{offer}Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n").encode())
        self.file = self.link.makefile("rb")
        assert b"101" in self.file.readline()
        self.protocol = None
        for line in iter(self.file.readline, b"\r\n"):
            if line.lower().startswith(b"sec-websocket-protocol:"):
                self.protocol = line.split(b":")[1].strip().decode()

    def send(self, opcode, payload):
        mask = os.urandom(4)
        size = bytes([0x80 | len(payload)]) if len(payload) < 126 else bytes([0x80 | 126]) + struct.pack(">H", len(payload))
        self.link.sendall(bytes([0x80 | opcode]) + size + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(payload)))

    def order(self, **order):
        self.send(1, json.dumps(order).encode())

    def frame_of_any_kind(self):
        """Opcode and payload of the next one that is no ping, which is answered; None at the connection's end."""
        while True:
            head = self.file.read(2)
            if len(head) < 2:
                return None
            length = head[1]
            if length == 126:
                length = struct.unpack(">H", self.file.read(2))[0]
            elif length == 127:
                length = struct.unpack(">Q", self.file.read(8))[0]
            opcode, payload = head[0] & 15, self.file.read(length)
            if opcode == 9:
                self.send(10, payload)
            elif opcode in (1, 2):
                return opcode, payload
            else:
                return None

    def message(self, *kinds):
        """The page's next message, of these kinds alone where some are named; None at the connection's end."""
        while True:
            got = self.frame_of_any_kind()
            if got is None:
                return None
            message = json.loads(got[1])
            if not kinds or message["kind"] in kinds:
                return message

    def frame(self):
        """The next frame of a tick; None at the connection's end."""
        return self.message("frame")

    def frame_where(self, holds):
        """The next frame that it holds for; all of them are waited for."""
        frame = self.frame()
        while not holds(frame):
            frame = self.frame()
        return frame

    def last_frame(self):
        """The frame that tells the outcome; the run ends once this client is closed."""
        frame = self.frame_where(lambda frame: not frame or frame["ended"])
        self.close()
        return frame

    def close(self):
        self.file.close()
        self.link.close()
