"""One drive as three recordings of ROS's tools, written from the formats' specifications with Python's own library alone.

usage: make_bags.py SCAN.txt[.gz] ODOM.txt[.gz] FOLDER X,Y,YAW [one_more_scanner]
Writes drive.bag (ROS 1, a chunk in bzip2 and one unpacked), drive.mcap (ROS 2, a chunk with its CRC) and drive_ros2/ (a
ROS 2 bag on sqlite3). The laser's mount is in /tf_static, as two frames one behind the other.
"""
import bz2
import gzip
import math
import os
import sqlite3
import struct
import sys
import zlib

TYPES = {"/scan": "sensor_msgs/LaserScan", "/scan_rear": "sensor_msgs/LaserScan", "/odom": "nav_msgs/Odometry",
         "/tf_static": "tf2_msgs/TFMessage", "/chatter": "std_msgs/String"}


class Message:
    """Fields in OMG's CDR, little endian, or as ROS 1 has them: packed."""

    def __init__(self, ros1=False):
        self.ros1, self.bytes = ros1, bytearray()

    def put(self, code, *values):
        size = 1 if self.ros1 else struct.calcsize("<" + code)
        for value in values:
            self.bytes += b"\0" * (-len(self.bytes) % size) + struct.pack("<" + code, value)

    def text(self, text):
        end = b"" if self.ros1 else b"\0"
        self.put("I", len(text) + len(end))
        self.bytes += text.encode() + end

    def header(self, ns, frame):
        self.put("I", *[0] * self.ros1, ns // 10**9, ns % 10**9)
        self.text(frame)

    def message(self):
        return (b"" if self.ros1 else b"\0\1\0\0") + bytes(self.bytes)


def turn(out, yaw):
    out.put("d", 0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2))


def scan(out, ns, words):
    first, step, low, high, count = float(words[1]), float(words[2]), float(words[3]), float(words[4]), int(words[5])
    out.header(ns, "laser")
    out.put("f", first, first + step * (count - 1), step, 0.0, 0.0, low, high)
    out.put("I", count)
    out.put("f", *[float(word) for word in words[6:]])
    out.put("I", 0)
    return out.message()


def odometry(out, ns, words):
    x, y, yaw, v, w = [float(word) for word in words[1:]]
    out.header(ns, "odom")
    out.text("base_link")
    out.put("d", x, y, 0.0)
    turn(out, yaw)
    out.put("d", *[0.0] * 36)
    out.put("d", v, 0.0, 0.0, 0.0, 0.0, w)
    out.put("d", *[0.0] * 36)
    return out.message()


def mount(out, ns, x, y, yaw):
    out.put("I", 2)
    for parent, child, at, heading in (("base_link", "mast", (x, y, 1.0), 0.0), ("mast", "laser", (0.0, 0.0, 0.1), yaw)):
        out.header(ns, parent)
        out.text(child)
        out.put("d", *at)
        turn(out, heading)
    return out.message()


def text(out, _, words):
    out.text(words)
    return out.message()


def sized(data):
    return struct.pack("<I", len(data)) + data


def fields(**values):
    return b"".join(sized(name.encode() + b"=" + value) for name, value in values.items())


def write_ros1(path, events):
    numbers = {topic: k for k, topic in enumerate(TYPES)}

    def connection(topic):
        said = fields(topic=topic.encode(), type=TYPES[topic].encode(), md5sum=b"*", message_definition=b"")
        return sized(fields(op=b"\7", conn=struct.pack("<I", numbers[topic]), topic=topic.encode())) + sized(said)

    def chunk(part, method):
        inner, known = b"", set()
        for ns, topic, make, words in part:
            inner += connection(topic) if topic not in known else b""
            known.add(topic)
            time = struct.pack("<II", ns // 10**9, ns % 10**9)
            head = fields(op=b"\2", conn=struct.pack("<I", numbers[topic]), time=time)
            inner += sized(head) + sized(make(Message(ros1=True), ns, words))
        packed = bz2.compress(inner) if method == b"bz2" else inner
        return sized(fields(op=b"\5", compression=method, size=struct.pack("<I", len(inner)))) + sized(packed)

    chunks = chunk(events[:len(events) // 2], b"bz2") + chunk(events[len(events) // 2:], b"none")
    begin = b"#ROSBAG V2.0\n"
    index = len(begin) + 4096 + len(chunks)
    head = sized(fields(op=b"\3", index_pos=struct.pack("<Q", index), conn_count=struct.pack("<I", len(TYPES)),
                        chunk_count=struct.pack("<I", 2)))
    head += sized(b" " * (4096 - len(head) - 4))
    with open(path, "wb") as out:
        out.write(begin + head + chunks + b"".join(connection(topic) for topic in TYPES))


def write_mcap(path, events):
    def record(op, body):
        return struct.pack("<BQ", op, len(body)) + body

    numbers = {topic: k + 1 for k, topic in enumerate(TYPES)}
    records = b""
    for topic, number in numbers.items():
        name = TYPES[topic].replace("/", "/msg/").encode()
        records += record(3, struct.pack("<H", number) + sized(name) + sized(b"ros2msg") + sized(b""))
        records += record(4, struct.pack("<HH", number, number) + sized(topic.encode()) + sized(b"cdr") + sized(b""))
    for ns, topic, make, words in events:
        records += record(5, struct.pack("<HIQQ", numbers[topic], 0, ns, ns) + make(Message(), ns, words))
    chunk = struct.pack("<QQQI", events[0][0], events[-1][0], len(records), zlib.crc32(records)) + sized(b"")
    data = b"\x89MCAP0\r\n" + record(1, sized(b"ros2") + sized(b"test"))
    data += record(6, chunk + struct.pack("<Q", len(records)) + records)
    with open(path, "wb") as out:
        out.write(data + record(15, struct.pack("<I", zlib.crc32(data))) + record(2, bytes(20)) + b"\x89MCAP0\r\n")


def write_ros2(folder, events):
    os.makedirs(folder, exist_ok=True)
    with open(folder + "/metadata.yaml", "w") as out:
        out.write("rosbag2_bagfile_information:\n  version: 4\n  storage_identifier: sqlite3\n"
                  "  relative_file_paths:\n    - drive_0.db3\n  compression_format: \"\"\n  compression_mode: \"\"\n")
    file = folder + "/drive_0.db3"
    if os.path.exists(file):
        os.remove(file)
    base = sqlite3.connect(file)
    base.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
                 "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)")
    base.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,"
                 "data BLOB NOT NULL)")
    numbers = {topic: k + 1 for k, topic in enumerate(TYPES)}
    for topic, number in numbers.items():
        base.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')",
                     (number, topic, TYPES[topic].replace("/", "/msg/")))
    for ns, topic, make, words in events:
        base.execute("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                     (numbers[topic], ns, make(Message(), ns, words)))
    base.commit()
    base.close()


def lines(path):
    with (gzip.open if path.endswith(".gz") else open)(path, "rt") as file:
        return [line.split() for line in file if line.strip() and not line.startswith("#")]


def main():
    out, where = sys.argv[3], [float(word) for word in sys.argv[4].split(",")]

    def stamp(words):
        return int(float(words[0]) * 1e9 + 0.5)

    events = [(stamp(words), "/scan", scan, words) for words in lines(sys.argv[1])]
    events += [(stamp(words), "/odom", odometry, words) for words in lines(sys.argv[2])]
    if sys.argv[5:]:
        events += [(ns, "/scan_rear", make, words) for ns, topic, make, words in events if topic == "/scan"]
    events.sort(key=lambda event: event[0])
    first = events[0][0]
    events.insert(0, (first, "/tf_static", lambda out, ns, at: mount(out, ns, *at), where))
    events.insert(1, (first, "/chatter", text, "hello"))
    write_ros1(out + "/drive.bag", events)
    write_mcap(out + "/drive.mcap", events)
    write_ros2(out + "/drive_ros2", events)


if __name__ == "__main__":
    main()
