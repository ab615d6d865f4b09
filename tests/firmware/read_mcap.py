"""An MCAP file read by its specification alone: magic, records, CRCs of chunks and summary, indexes, counts.

usage: read_mcap.py RUN.mcap ROBOT.csv
Prints a line a topic; ends with 1 and a word of what is wrong otherwise.
"""
import collections
import csv
import ctypes
import ctypes.util
import math
import struct
import sys
import zlib

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX, STATISTICS = 1, 2, 3, 4, 5, 6, 7, 8, 11


def require(holds, what):
    if not holds:
        sys.exit(f"{sys.argv[1]}: {what}")


def records(data, begin, end):
    while begin < end:
        op, size = struct.unpack_from("<BQ", data, begin)
        yield op, begin, data[begin + 9:begin + 9 + size]
        begin += 9 + size


def text(data, at):
    size = struct.unpack_from("<I", data, at)[0]
    return data[at + 4:at + 4 + size].decode(), at + 4 + size


def unpacked(packed, size):
    zstd = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
    zstd.ZSTD_decompress.restype = ctypes.c_size_t
    out = ctypes.create_string_buffer(size)
    got = zstd.ZSTD_decompress(out, ctypes.c_size_t(size), packed, ctypes.c_size_t(len(packed)))
    return out.raw if got == size else b""


def transforms(message):
    """(parent, child, x, y, heading) each of a tf2_msgs/TFMessage in CDR; the encapsulation has 4 bytes."""
    at, found = 8, []
    for _ in range(struct.unpack_from("<I", message, 4)[0]):
        names, at = [], (at + 3) // 4 * 4 + 8  # the stamp
        for _ in range(2):
            at = (at + 3) // 4 * 4
            size = struct.unpack_from("<I", message, at)[0]
            names.append(message[at + 4:at + 3 + size].decode())
            at += 4 + size
        at = (at - 4 + 7) // 8 * 8 + 4
        x, y, _, _, _, z, w = struct.unpack_from("<7d", message, at)
        at += 56
        found.append((*names, x, y, 2.0 * math.atan2(z, w)))
    return found


def joined(a, b):
    """Two poses in a row: x, y, heading."""
    return (a[0] + math.cos(a[2]) * b[0] - math.sin(a[2]) * b[1],
            a[1] + math.sin(a[2]) * b[0] + math.cos(a[2]) * b[1], a[2] + b[2])


def read(data):
    """Topics by channel, messages by topic, chunk indexes, the statistics' counts."""
    topics, messages, indexes, counts = {}, collections.defaultdict(list), [], {}
    for op, at, body in records(data, len(MAGIC), len(data) - len(MAGIC)):
        if op == CHUNK:
            first, last, size, crc = struct.unpack_from("<QQQI", body)
            method, begin = text(body, 28)
            require(method == "zstd", f"the chunk at {at} is not packed with zstd")
            chunk = unpacked(body[begin + 8:], size)
            require(len(chunk) == size and zlib.crc32(chunk) == crc, f"the chunk at {at} has another CRC or size")
            for inner, _, record in records(chunk, 0, len(chunk)):
                if inner == CHANNEL:
                    topics[struct.unpack_from("<H", record)[0]] = text(record, 4)[0]
                if inner == MESSAGE:
                    channel, _, time = struct.unpack_from("<HIQ", record)
                    require(first <= time <= last, "a message outside its chunk's times")
                    messages[topics[channel]].append((time, record[22:]))
        if op == CHUNK_INDEX:
            indexes.append(struct.unpack_from("<QQQQ", body))
        if op == STATISTICS:
            total, size = struct.unpack_from("<Q", body)[0], struct.unpack_from("<I", body, 42)[0]
            pairs = struct.iter_unpack("<HQ", body[46:46 + size])
            counts = {topics[channel]: count for channel, count in pairs}
            require(total == sum(counts.values()), "the statistics do not add up")
    return messages, indexes, counts


def main():
    data = open(sys.argv[1], "rb").read()
    require(data.startswith(MAGIC) and data.endswith(MAGIC), "no magic at its ends")
    messages, indexes, counts = read(data)
    footer = len(data) - len(MAGIC) - 29
    start, _, crc = struct.unpack_from("<QQI", data, footer + 9)
    require(data[footer] == FOOTER and zlib.crc32(data[start:footer + 25]) == crc, "the summary has another CRC")
    for _, _, at, size in indexes:
        require(data[at] == CHUNK and struct.unpack_from("<Q", data, at + 1)[0] + 9 == size, "an index beside its chunk")
    require(counts == {topic: len(found) for topic, found in messages.items()}, "other counts than the statistics say")
    rows = list(csv.DictReader(open(sys.argv[2])))
    require(len(rows) == len(messages["/odom"]), "other than one /odom a tick")
    require(all(body[12:21] == b"\x05\0\0\0odom\0" for _, body in messages["/odom"]), "/odom is not in odom")
    static = [t[:2] for _, body in messages["/tf_static"] for t in transforms(body)]
    require(static == [("base_link", "laser")], "/tf_static is not base_link to laser, once")
    require(all(struct.unpack_from("<iI", body, 4) == divmod(time, 10**9) for time, body in messages["/clock"]), "/clock says another time")
    require(any(b"expected\0" in body for _, body in messages["/tracks"]), "/tracks shows nobody's way ahead")
    for row, (time, body) in zip(rows, messages["/tf"]):
        (*first, mx, my, mh), (*second, ox, oy, oh) = transforms(body)
        require((first, second) == (["map", "odom"], ["odom", "base_link"]), "/tf is not map to odom to base_link")
        x, y, _ = joined((mx, my, mh), (ox, oy, oh))
        near = math.isclose(x, float(row["est_x_m"]), abs_tol=1e-3) and math.isclose(y, float(row["est_y_m"]), abs_tol=1e-3)
        require(near and math.isclose(time * 1e-9, float(row["t_s"]), abs_tol=1e-3), f"another pose at {row['t_s']} s")
    for topic, found in sorted(messages.items()):
        print(topic, len(found))


if __name__ == "__main__":
    main()
