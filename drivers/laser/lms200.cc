#include "drivers/laser/lms200.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "hal/types/trig.h"

namespace jaywalk::lms200 {
namespace {

constexpr std::uint8_t kStx = 0x02, kAck = 0x06, kFromScanner = 0x80, kAllValues = 0xB0;
constexpr std::size_t kHeader = 4, kChecksum = 2;
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

float range_of(std::uint16_t value, float metres_per_count) noexcept {
  if ((value & kDazzled) != 0) return 0.0F;
  const std::uint16_t counts = value & kDistanceBits;
  if (counts == kBeyond) return std::numeric_limits<float>::infinity();
  return counts <= kFarthest ? static_cast<float>(counts) * metres_per_count : 0.0F;
}

Decoding judge(unsigned status) noexcept {
  const bool error = (status & kSeverity) >= kError;
  if (error && (status & kPolluted) != 0) return Decoding::kDirty;
  return error || (status & kImplausible) != 0 ? Decoding::kDeviceError : Decoding::kScan;
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

Command framed(std::initializer_list<std::uint8_t> body) noexcept {
  Command out;
  const auto push = [&out](unsigned byte) { return out.push_back(static_cast<std::uint8_t>(byte)); };
  bool fits = push(kStx) && push(0) && push(static_cast<unsigned>(body.size())) && push(0);
  for (const std::uint8_t byte : body) fits = fits && push(byte);
  const unsigned crc = crc16({out.data(), out.size()});
  fits = fits && push(crc) && push(crc >> 8U);
  if (!fits) out.clear();
  return out;
}

void TelegramStream::forget() noexcept {
  queue_.clear();
  handed_out_ = 0;
}

std::optional<wire::Bytes> TelegramStream::next() noexcept {
  queue_.drop(handed_out_);
  handed_out_ = 0;
  for (;;) {
    const wire::Bytes waiting = queue_.waiting();
    if (waiting.size() < kHeader) return std::nullopt;
    const std::size_t length = wire::little_endian<std::uint16_t>(waiting.subspan(2));
    const bool begins = waiting[0] == kStx && waiting[1] == kFromScanner && length >= 1 && length <= kMostBody;
    const std::size_t whole = kHeader + length + kChecksum;
    if (begins && waiting.size() < whole) return std::nullopt;
    if (begins && crc16(waiting.first(whole - kChecksum)) ==
                      wire::little_endian<std::uint16_t>(waiting.subspan(whole - kChecksum))) {
      handed_out_ = whole;
      return waiting.subspan(kHeader, length);
    }
    if (waiting[0] != kAck) ++skipped_;
    queue_.drop(1);
  }
}

Decoding decode_scan(wire::Bytes body, std::uint32_t baud, Time arrival, LaserScan& scan) noexcept {
  wire::ByteReader reader(body);
  if (reader.little<std::uint8_t>() != kAllValues) return Decoding::kOtherMessage;
  const auto head = reader.little<std::uint16_t>();
  const std::uint32_t count = head & 0x3FFU;
  const unsigned unit = head >> 14U;
  if ((head & 0x3C00U) != 0 || unit > 1) return Decoding::kBadField;  // a part of a scan, or no unit
  const auto* const fan = std::find_if(kFans.begin(), kFans.end(), [count](const Fan& f) { return f.values == count; });
  if (fan == kFans.end()) return Decoding::kBadField;
  const float metres_per_count = unit == 0 ? 0.01F : 0.001F;
  for (std::uint32_t k = 0; k < count; ++k)
    scan.range_m[k] = range_of(reader.little<std::uint16_t>(), metres_per_count);
  const auto status = reader.little<std::uint8_t>();
  if (!reader.ok()) return Decoding::kTruncated;
  if (judge(status) != Decoding::kScan) return judge(status);
  scan.beam_count = count;
  scan.range_min_m = 0.01F;
  scan.range_max_m = static_cast<float>(kFarthest) * metres_per_count;
  place(*fan, kHeader + body.size() + kChecksum, baud, arrival, scan);
  return Decoding::kScan;
}

bool warns(wire::Bytes body) noexcept {
  return !body.empty() && ((body.back() & kSeverity) == kWarning || (body.back() & kPolluted) != 0);
}

void Lms200Protocol::begin() noexcept {
  at_ = 0;
  asked_ = false;
  stream_.forget();
}

wire::Bytes Lms200Protocol::to_say(Time) noexcept {
  if (asked_ || at_ == steps_.size()) return {};
  asked_ = true;
  return {steps_[at_].data(), steps_[at_].size()};
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
  if (at_ < steps_.size()) return Heard::kAnswer;  // what it still sends from before
  const Heard heard = heard_of(decode_scan(*body, baud_, arrival, scan));
  if (heard == Heard::kScan && warns(*body)) ++warned_;
  return heard;
}

}  // namespace jaywalk::lms200
