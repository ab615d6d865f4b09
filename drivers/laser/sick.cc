#include "drivers/laser/sick.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>

#include "hal/types/trig.h"

namespace jaywalk::sick {
namespace {

constexpr std::uint8_t kStx = 0x02, kEtx = 0x03;
constexpr std::array<std::uint8_t, 4> kBeginningB{kStx, kStx, kStx, kStx};
constexpr std::size_t kHeaderB = 8;

std::uint8_t xor_of(wire::Bytes bytes) noexcept {
  std::uint8_t sum = 0;
  for (const std::uint8_t byte : bytes) sum ^= byte;
  return sum;
}

std::size_t position(wire::Bytes bytes, std::uint8_t wanted) noexcept {
  return static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), wanted) - bytes.begin());
}

/// The fields of a body. CoLa B: big-endian numbers of fixed size. CoLa A: words between blanks, numbers in
/// hexadecimal.
class Fields {
 public:
  Fields(Cola dialect, wire::Bytes body) noexcept : is_text_(dialect == Cola::kA), reader_(body) {}

  std::uint32_t u8() noexcept { return number<std::uint8_t>(); }
  std::uint32_t u16() noexcept { return number<std::uint16_t>(); }
  std::uint32_t u32() noexcept { return number<std::uint32_t>(); }
  /// A channel's name, which has five letters in CoLa B.
  std::string_view word() noexcept {
    if (!is_text_) return wire::text_of(reader_.take(5));
    const std::string_view rest = wire::text_of(reader_.rest());
    const std::size_t begin = std::min(rest.find_first_not_of(' '), rest.size());
    const std::string_view found = rest.substr(begin, rest.find(' ', begin) - begin);
    reader_.take(begin + found.size());
    is_malformed_ = is_malformed_ || found.empty();
    return found;
  }
  [[nodiscard]] bool ok() const noexcept { return reader_.ok() && !is_malformed_; }

 private:
  template <class T>
  std::uint32_t number() noexcept {
    if (!is_text_) return reader_.big<T>();
    const std::string_view digits = word();
    T value = 0;
    const auto parsed = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
    if (parsed.ec == std::errc{} && parsed.ptr == digits.data() + digits.size()) return value;
    is_malformed_ = true;
    return 0;
  }

  bool is_text_, is_malformed_ = false;
  wire::ByteReader reader_;
};

/// How a channel's numbers become lengths and angles.
struct Channel {
  bool is_distance = false;
  float metres_per_count = 0.0F;
  float offset_m = 0.0F;
  double first_angle_rad = 0.0;
  double step_rad = 0.0;
  std::uint32_t count = 0;
};

constexpr double kRadPerTick = kPi / 180.0 / 10000.0;  // angles come in ten-thousandths of a degree
constexpr double kAheadRad = kPi / 2.0;
/// Counts below are no distances: 0 no valid measurement, 1 dazzled, the rest reserved (SICK LMS4000, 8023198, 12.1;
/// the same telegram). The largest that the field holds is no distance that one of these scanners measures.
constexpr std::uint32_t kLeastCounts = 16, kBeyondCounts = 0xFFFF;
/// Device status, as in SICK's telegram listing (8014631) and LMS5xx (8013796, 10.2).
constexpr std::uint32_t kError = 1, kDirtWarning = 2, kDirtError = 4;

Channel read_channel(Fields& fields) noexcept {
  Channel channel;
  channel.is_distance = fields.word() == "DIST1";
  channel.metres_per_count = std::bit_cast<float>(fields.u32()) * 0.001F;
  channel.offset_m = std::bit_cast<float>(fields.u32()) * 0.001F;
  channel.first_angle_rad = static_cast<double>(static_cast<std::int32_t>(fields.u32())) * kRadPerTick - kAheadRad;
  channel.step_rad = static_cast<double>(fields.u16()) * kRadPerTick;
  channel.count = fields.u16();
  return channel;
}

/// Whole turns and sane scales only; false for NaN.
bool is_plausible(const Channel& channel) noexcept {
  return channel.metres_per_count > 0.0F && channel.metres_per_count <= 1.0F && std::fabs(channel.offset_m) <= 100.0F &&
         std::fabs(channel.first_angle_rad) <= 4.0 * kPi && channel.step_rad > 0.0 && channel.count >= kLeastBeams &&
         channel.step_rad * channel.count <= 2.0 * kPi + channel.step_rad;
}

bool read_distances(Fields& fields, const Channel& channel, LaserScan& scan) noexcept {
  if (channel.count > kMaxBeams || !is_plausible(channel)) return false;
  scan.beam_count = channel.count;
  scan.first_angle_rad = static_cast<float>(channel.first_angle_rad);
  scan.angle_step_rad = static_cast<float>(channel.step_rad);
  for (std::uint32_t beam = 0; beam < channel.count; ++beam) {
    const std::uint32_t counts = fields.u16();
    const bool measured = counts >= kLeastCounts && counts < kBeyondCounts;
    scan.range_m[beam] = measured ? static_cast<float>(counts) * channel.metres_per_count + channel.offset_m : 0.0F;
  }
  return fields.ok();
}

/// The header up to the number of encoders; the scanner's frequency in hundredths of a hertz.
Heard read_header(Fields& fields, ScanHeader& header, std::uint32_t& frequency_centihertz) noexcept {
  fields.u16();  // version
  fields.u16();  // device number
  fields.u32();  // serial number
  fields.u8();
  const std::uint32_t status = fields.u8();
  header.telegram_counter = static_cast<std::uint16_t>(fields.u16());
  fields.u16();  // scan counter
  header.scan_time_us = fields.u32();
  header.sent_time_us = fields.u32();
  for (int inputs_and_outputs = 0; inputs_and_outputs < 4; ++inputs_and_outputs) fields.u8();
  fields.u16();  // layer angle
  frequency_centihertz = fields.u32();
  fields.u32();  // measuring frequency
  if (!fields.ok()) return Heard::kMalformed;
  header.warns_of_dirt = (status & kDirtWarning) != 0;
  if ((status & kError) != 0) return Heard::kDeviceError;
  if ((status & kDirtError) != 0) return Heard::kDirty;
  return frequency_centihertz >= 10 && frequency_centihertz <= 100000 ? Heard::kScan : Heard::kMalformed;
}

/// False where there is no channel of first distances.
bool read_channels(Fields& fields, LaserScan& scan) noexcept {
  const std::uint32_t encoders = fields.u16();
  if (encoders > 3) return false;
  for (std::uint32_t k = 0; k < encoders; ++k) {
    fields.u32();
    fields.u16();
  }
  const std::uint32_t channels = fields.u16();
  for (std::uint32_t k = 0; k < channels && fields.ok(); ++k) {
    const Channel channel = read_channel(fields);
    if (!fields.ok()) break;
    if (channel.is_distance) return read_distances(fields, channel, scan);
    for (std::uint32_t value = 0; value < channel.count; ++value) fields.u16();
  }
  return false;
}

Heard read_scan(Fields fields, const ScannerModel& model, Time arrival, LaserScan& scan, ScanHeader& header) noexcept {
  std::uint32_t frequency_centihertz = 0;
  const Heard of_header = read_header(fields, header, frequency_centihertz);
  if (of_header != Heard::kScan) return of_header;
  if (!read_channels(fields, scan)) return Heard::kMalformed;
  const double period_s = 100.0 / static_cast<double>(frequency_centihertz);
  const double swept_rad =
      static_cast<double>(scan.angle_step_rad) * (scan.beam_count > 0 ? scan.beam_count - 1.0 : 0.0);
  scan.period = duration_from_seconds(period_s);
  scan.sweep = duration_from_seconds(period_s * swept_rad / (2.0 * kPi));
  const Duration held = std::chrono::microseconds(header.sent_time_us - header.scan_time_us);  // right across the wrap
  scan.stamp = arrival - std::min(held, scan.period) - scan.sweep;
  scan.range_min_m = model.range_min_m;
  scan.range_max_m = model.range_max_m;
  return Heard::kScan;
}

using namespace std::string_view_literals;

/// Word of each command, which its answer repeats.
constexpr std::array<std::string_view, 4> kWords{"SetAccessMode", "LMDscandatacfg", "Run", "LMDscandata"};
// "client", hashed as the scanner wants it; level 3 is the authorised client.
// Channel 1, no remission, 16 bits, unit 0, no encoder, no position, no name, no comment, no time, every scan.
constexpr std::array<std::string_view, 4> kInText{"sMN SetAccessMode 03 F4724744"sv,
                                                  "sWN LMDscandatacfg 01 00 0 1 0 00 00 0 0 0 0 +1"sv, "sMN Run"sv,
                                                  "sEN LMDscandata 1"sv};
constexpr std::array<std::string_view, 4> kInBinary{
    "sMN SetAccessMode \x03\xF4\x72\x47\x44"sv,
    "sWN LMDscandatacfg \x01\x00\x00\x01\x00\x00\x00\x00\x00\x00\x00\x00\x01"sv, "sMN Run"sv, "sEN LMDscandata \x01"sv};
/// More telegrams than this do not go missing on a connection that lives: the scanner began to count anew.
constexpr std::uint16_t kMostLost = 1000;

}  // namespace

std::optional<wire::Bytes> ColaStream::next_a() noexcept {
  for (;;) {
    skip(position(waiting(), kStx));
    const wire::Bytes rest = waiting();
    if (rest.empty()) return std::nullopt;
    const std::size_t end = position(rest, kEtx);
    // A second beginning before the end: the first telegram was cut off.
    const std::size_t again = 1 + position(rest.subspan(1), kStx);
    if (again < end) {
      skip(again);
      continue;
    }
    if (end == rest.size() && end <= kMaxBody) return std::nullopt;
    if (end > kMaxBody) {
      skip(1);
      continue;
    }
    drop(end + 1);
    return rest.subspan(1, end - 1);
  }
}

std::optional<wire::Bytes> ColaStream::next_b() noexcept {
  for (;;) {
    const wire::Bytes all = waiting();
    const auto found = std::search(all.begin(), all.end(), kBeginningB.begin(), kBeginningB.end());
    if (found == all.end()) {
      skip(all.size() - std::min(all.size(), kBeginningB.size() - 1));  // its last bytes may begin a beginning
      return std::nullopt;
    }
    skip(static_cast<std::size_t>(found - all.begin()));
    const wire::Bytes rest = waiting();
    if (rest.size() < kHeaderB) return std::nullopt;
    const std::size_t length = wire::big_endian<std::uint32_t>(rest.subspan(4));
    if (length == 0 || length > kMaxBody) {
      skip(1);
      continue;
    }
    if (rest.size() < kHeaderB + length + 1) return std::nullopt;
    const wire::Bytes body = rest.subspan(kHeaderB, length);
    if (xor_of(body) != rest[kHeaderB + length]) {
      skip(1);
      continue;
    }
    drop(kHeaderB + length + 1);
    return body;
  }
}

ColaCommand framed(Cola dialect, std::string_view command) noexcept {
  const bool is_text = dialect == Cola::kA;
  const wire::Bytes body(reinterpret_cast<const std::uint8_t*>(command.data()), command.size());
  std::array<std::uint8_t, kHeaderB> header{kStx, kStx, kStx, kStx};
  wire::put_big_endian(static_cast<std::uint32_t>(body.size()), std::span(header).subspan(4));
  ColaCommand out;
  bool fits = true;
  const auto push = [&](std::uint8_t byte) { fits = fits && out.push_back(byte); };
  for (const std::uint8_t byte : wire::Bytes(header).first(is_text ? 1 : kHeaderB)) push(byte);
  for (const std::uint8_t byte : body) push(byte);
  push(is_text ? kEtx : xor_of(body));
  if (!fits) out.clear();
  return out;
}

Heard decode_scan(Cola dialect, wire::Bytes body, const ScannerModel& model, Time arrival, LaserScan& scan,
                  ScanHeader& header) noexcept {
  // Sent on its own (sSN) or in answer to one question (sRA).
  const std::string_view text = wire::text_of(body);
  const std::string_view kind = text.substr(0, 16);
  if (kind != "sSN LMDscandata " && kind != "sRA LMDscandata ") return Heard::kAnswer;
  return read_scan(Fields(dialect, body.subspan(kind.size())), model, arrival, scan, header);
}

void SickProtocol::begin() noexcept {
  at_ = 0;
  asked_ = false;
  if (tried_ && !understood_) dialect_ = dialect_ == Cola::kA ? Cola::kB : Cola::kA;
  stream_.begin(dialect_);
  tried_ = true;
  device_clock_.forget();
  last_counter_.reset();
}

wire::Bytes SickProtocol::to_say(Time) noexcept {
  if (asked_ || at_ == kWords.size()) return {};
  asked_ = true;
  said_ = framed(dialect_, (dialect_ == Cola::kA ? kInText : kInBinary)[at_]);
  return {said_.data(), said_.size()};
}

Heard SickProtocol::next(Time arrival, LaserScan& scan) noexcept {
  const auto body = stream_.next();
  if (!body) return Heard::kNothing;
  understood_ = true;
  ScanHeader header;
  const Heard heard = decode_scan(dialect_, *body, model_, arrival, scan, header);
  if (heard == Heard::kAnswer) return on_answer(wire::text_of(*body));
  if (heard == Heard::kScan) {
    count_lost(header.telegram_counter);
    if (header.warns_of_dirt) ++warned_;
    scan.stamp -= device_clock_.delay(header.sent_time_us, arrival);
  }
  return heard;
}

// "sAN Run 1", "sWA LMDscandatacfg", "sEA LMDscandata 1", or "sFA" and a number for any command that is refused.
Heard SickProtocol::on_answer(std::string_view body) noexcept {
  if (!asked_ || body.size() < 3) return Heard::kAnswer;
  bool taken = false;
  if (body.substr(0, 3) != "sFA") {
    const std::string_view rest = body.substr(std::min<std::size_t>(4, body.size()));
    const std::string_view word = rest.substr(0, rest.find(' '));
    if (word != kWords[at_]) return Heard::kAnswer;
    const char last = rest.back();
    taken = word.size() == rest.size() || last == '1' || last == '\x01';
  }
  return conclude(taken) ? Heard::kAnswer : Heard::kRefused;
}

bool SickProtocol::conclude(bool taken) noexcept {
  const bool must = at_ + 1 == kWords.size();
  if (!taken && must) return false;
  asked_ = false;
  ++at_;
  if (!taken) ++refused_;
  return true;
}

void SickProtocol::count_lost(std::uint16_t telegram_counter) noexcept {
  const auto missing = static_cast<std::uint16_t>(telegram_counter - last_counter_.value_or(0) - 1);
  if (last_counter_ && missing <= kMostLost) lost_ += missing;
  last_counter_ = telegram_counter;
}

}  // namespace jaywalk::sick
