#include <algorithm>
#include <array>

#include "drivers/laser/serial_scanners.h"

namespace jaywalk::rplidar {
namespace {

constexpr std::array<std::uint8_t, 2> kStopRequest{0xA5, 0x25}, kScanRequest{0xA5, 0x20};
/// The motor on at 660 of 1023, as the maker's own software has it, and the question how the scanner is.
constexpr std::array<std::uint8_t, 8> kMotorOnAndHealth{0xA5, 0xF0, 0x02, 0x94, 0x02, 0xC1, 0xA5, 0x52};

constexpr std::size_t kNodeBytes = 5, kHealthBytes = 3;
// Descriptors, which introduce an answer: bytes of each part, 40h where part follows part until it is stopped, type.
constexpr std::array<std::uint8_t, 7> kHealthComes{0xA5, 0x5A, kHealthBytes, 0, 0, 0, 0x06};
constexpr std::array<std::uint8_t, 7> kNodesCome{0xA5, 0x5A, kNodeBytes, 0, 0, 0x40, 0x81};

/// A turn's last points may lie beyond its end, by less than the widest step between two at the fewest points a turn.
constexpr double kMostAngle_deg = 370.0;

/// After a stop it hears nothing for a millisecond; its last points need some more to come in.
constexpr Duration kPause = std::chrono::milliseconds(20);
/// Check bits of one node fit one time in four by chance; of so many in a row hardly ever.
constexpr std::size_t kInARow = 5;

}  // namespace

std::optional<Node> decode_node(wire::Bytes bytes) noexcept {
  wire::ByteReader reader(bytes);
  const auto first = reader.little<std::uint8_t>();
  const auto angle = reader.little<std::uint16_t>();
  const auto range = reader.little<std::uint16_t>();
  const bool begins = (first & 1U) != 0;
  const bool begins_not = (first & 2U) != 0;
  if (!reader.ok() || begins == begins_not || (angle & 1U) == 0) return std::nullopt;
  double angle_deg = (angle >> 1U) / 64.0;
  if (angle_deg >= kMostAngle_deg) return std::nullopt;
  if (angle_deg >= 360.0) angle_deg -= 360.0;
  return Node{angle_deg, static_cast<float>(range) * 0.00025F};
}

void RplidarProtocol::begin() noexcept {
  step_ = Step::kStop;
  answer_found_ = false;
  lost_step_ = true;
  queue_.clear();
  turn_.forget();
}

wire::Bytes RplidarProtocol::to_say(Time now) noexcept {
  switch (step_) {
    case Step::kStop:
      stopped_ = now;
      step_ = Step::kPause;
      return kStopRequest;
    case Step::kPause:
      if (age(stopped_, now) < kPause) return {};
      queue_.clear();
      step_ = Step::kHealth;
      return kMotorOnAndHealth;
    case Step::kAskScan: step_ = Step::kScan; return kScanRequest;
    default: return {};
  }
}

Heard RplidarProtocol::next(Time arrival, LaserScan& scan) noexcept {
  switch (step_) {
    case Step::kHealth: return on_health();
    case Step::kScan:
      if (!find(kNodesCome)) return Heard::kNothing;
      step_ = Step::kNodes;
      lost_step_ = false;
      return Heard::kAnswer;
    case Step::kNodes: return on_nodes(arrival, scan);
    default: return Heard::kNothing;
  }
}

/// Drops what stands before the descriptor, and it too; false until it came.
bool RplidarProtocol::find(wire::Bytes descriptor) noexcept {
  while (queue_.waiting().size() >= descriptor.size()) {
    if (std::ranges::equal(queue_.waiting().first(descriptor.size()), descriptor)) {
      queue_.drop(descriptor.size());
      return true;
    }
    queue_.skip(1);
  }
  return false;
}

Heard RplidarProtocol::on_health() noexcept {
  answer_found_ = answer_found_ || find(kHealthComes);
  if (!answer_found_ || queue_.waiting().size() < kHealthBytes) return Heard::kNothing;
  const std::uint8_t status = queue_.waiting()[0];  // 0 well, 1 warning, 2 broken: it will not scan
  queue_.drop(kHealthBytes);
  answer_found_ = false;
  step_ = Step::kAskScan;
  if (status == 1) ++warned_;
  return status >= 2 ? Heard::kRefused : Heard::kAnswer;
}

/// Enough nodes stand one after the other for chance to be ruled out.
bool RplidarProtocol::in_step() const noexcept {
  for (std::size_t k = 0; k < kInARow; ++k)
    if (!decode_node(queue_.waiting().subspan(k * kNodeBytes, kNodeBytes))) return false;
  return true;
}

Heard RplidarProtocol::on_nodes(Time arrival, LaserScan& scan) noexcept {
  while (queue_.waiting().size() >= (lost_step_ ? kInARow : 1) * kNodeBytes) {
    const auto node = decode_node(queue_.waiting());
    if (!node || (lost_step_ && !in_step())) {
      if (!lost_step_) turn_.forget();  // a turn with a hole does not count
      lost_step_ = true;
      queue_.skip(1);
      continue;
    }
    lost_step_ = false;
    queue_.drop(kNodeBytes);
    if (turn_.add(node->angle_deg, node->range_m, arrival, scan)) return Heard::kScan;
  }
  return Heard::kNothing;
}

}  // namespace jaywalk::rplidar
