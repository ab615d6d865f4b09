#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "drivers/laser/serial_scanners.h"
#include "hal/types/trig.h"

namespace jaywalk::lms200 {
namespace {

constexpr std::uint8_t kStx = 0x02, kAck = 0x06, kFromScanner = 0x80, kAllValues = 0xB0;
constexpr std::size_t kHeader = 4, kChecksum = 2;
constexpr std::size_t kMostBody = 812;  ///< the longest that the maker's list of telegrams has
constexpr double kTurn_s = 1.0 / 75.0;
constexpr std::uint16_t kFarthest = 8182, kBeyond = 8183, kDistanceBits = 0x1FFF, kDazzled = 0x8000;
/// The status byte: how bad in the three lowest bits (1 note, 2 warning, 3 error, 4 fatal), the device in the next two.
constexpr unsigned kSeverity = 7, kWarning = 2, kError = 3, kImplausible = 0x40, kPolluted = 0x80;

/// What a number of values means: they are the only ones there are.
struct Fan {
  std::uint32_t values;
  double field_deg, step_deg;
  int turns;
};
constexpr std::array<Fan, 5> kFans{
    {{181, 180.0, 1.0, 1}, {361, 180.0, 0.5, 2}, {101, 100.0, 1.0, 1}, {201, 100.0, 0.5, 2}, {401, 100.0, 0.25, 4}}};

/// Change to the mode of single questions (25h), then to the one that sends all values without end (24h).
constexpr std::array<std::array<std::uint8_t, 8>, 2> kCommands{
    {{kStx, 0, 2, 0, 0x20, 0x25, 0x35, 0x08}, {kStx, 0, 2, 0, 0x20, 0x24, 0x34, 0x08}}};

float range_of(std::uint16_t value, float metres_per_count) noexcept {
  if ((value & kDazzled) != 0) return 0.0F;
  const std::uint16_t counts = value & kDistanceBits;
  if (counts == kBeyond) return std::numeric_limits<float>::infinity();
  return counts <= kFarthest ? static_cast<float>(counts) * metres_per_count : 0.0F;
}

/// The status byte at the end of a body tells of dirt on the window, or of something else, that does no harm yet.
bool warns(wire::Bytes body) noexcept {
  return (body.back() & kSeverity) == kWarning || (body.back() & kPolluted) != 0;
}

Heard judge(unsigned status) noexcept {
  const bool error = (status & kSeverity) >= kError;
  if (error && (status & kPolluted) != 0) return Heard::kDirty;
  return error || (status & kImplausible) != 0 ? Heard::kDeviceError : Heard::kScan;
}

void place(const Fan& fan, std::size_t telegram_bytes, std::uint32_t baud, Time arrival, LaserScan& scan) noexcept {
  const double on_line_s = static_cast<double>(telegram_bytes) * 10.0 / baud;  // start and stop bit
  const double sweep_s = kTurn_s * (fan.turns - 1 + fan.field_deg / 360.0);
  const double turns = std::max(static_cast<double>(fan.turns), std::ceil(on_line_s / kTurn_s));
  scan.first_angle_rad = static_cast<float>(-0.5 * fan.field_deg * kPi / 180.0);
  scan.angle_step_rad = static_cast<float>(fan.step_deg * kPi / 180.0);
  scan.sweep = duration_from_seconds(sweep_s);
  scan.period = duration_from_seconds(turns * kTurn_s);
  scan.stamp = arrival - duration_from_seconds(on_line_s + sweep_s);
}

}  // namespace

std::uint16_t crc16(wire::Bytes bytes) noexcept {
  unsigned crc = 0;
  unsigned before = 0;
  for (const std::uint8_t byte : bytes) {
    crc = ((crc << 1U) ^ ((crc & 0x8000U) != 0 ? 0x8005U : 0U)) & 0xFFFFU;
    crc ^= before << 8U | byte;
    before = byte;
  }
  return static_cast<std::uint16_t>(crc);
}

std::optional<wire::Bytes> TelegramStream::next() noexcept {
  for (;;) {
    const wire::Bytes rest = waiting();
    if (rest.size() < kHeader) return std::nullopt;
    const std::size_t length = wire::little_endian<std::uint16_t>(rest.subspan(2));
    const bool begins = rest[0] == kStx && rest[1] == kFromScanner && length >= 1 && length <= kMostBody;
    const std::size_t whole = kHeader + length + kChecksum;
    if (begins && rest.size() < whole) return std::nullopt;
    if (begins &&
        crc16(rest.first(whole - kChecksum)) == wire::little_endian<std::uint16_t>(rest.subspan(whole - kChecksum))) {
      drop(whole);
      return rest.subspan(kHeader, length);
    }
    rest[0] == kAck ? drop(1) : skip(1);
  }
}

Heard decode_scan(wire::Bytes body, std::uint32_t baud, Time arrival, LaserScan& scan) noexcept {
  wire::ByteReader reader(body);
  if (reader.little<std::uint8_t>() != kAllValues) return Heard::kAnswer;
  const auto head = reader.little<std::uint16_t>();
  const std::uint32_t count = head & 0x3FFU;
  const unsigned unit = head >> 14U;
  if ((head & 0x3C00U) != 0 || unit > 1) return Heard::kMalformed;  // a part of a scan, or no unit
  const auto* const fan = std::find_if(kFans.begin(), kFans.end(), [count](const Fan& f) { return f.values == count; });
  if (fan == kFans.end()) return Heard::kMalformed;
  const float metres_per_count = unit == 0 ? 0.01F : 0.001F;
  for (std::uint32_t k = 0; k < count; ++k)
    scan.range_m[k] = range_of(reader.little<std::uint16_t>(), metres_per_count);
  const auto status = reader.little<std::uint8_t>();
  if (!reader.ok()) return Heard::kMalformed;
  if (judge(status) != Heard::kScan) return judge(status);
  scan.beam_count = count;
  scan.range_min_m = 0.01F;
  scan.range_max_m = static_cast<float>(kFarthest) * metres_per_count;
  place(*fan, kHeader + body.size() + kChecksum, baud, arrival, scan);
  return Heard::kScan;
}

void Lms200Protocol::begin() noexcept {
  at_ = 0;
  asked_ = false;
  stream_.clear();
}

wire::Bytes Lms200Protocol::to_say(Time) noexcept {
  if (asked_ || at_ == kCommands.size()) return {};
  asked_ = true;
  return kCommands[at_];
}

Heard Lms200Protocol::next(Time arrival, LaserScan& scan) noexcept {
  const auto body = stream_.next();
  if (!body) return Heard::kNothing;
  const bool answers = (*body)[0] == 0xA0 && body->size() >= 2;  // to a change of mode; then 0: done
  if (answers && asked_) {
    if ((*body)[1] != 0) return Heard::kRefused;
    asked_ = false;
    ++at_;
  }
  if (at_ < kCommands.size()) return Heard::kAnswer;  // what it still sends from before
  const Heard heard = decode_scan(*body, baud_, arrival, scan);
  if (heard == Heard::kScan && warns(*body)) ++warned_;
  return heard;
}

}  // namespace jaywalk::lms200
