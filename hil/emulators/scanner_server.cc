#include "hil/emulators/scanner_server.h"

#include <utility>

#include "hal/types/geometry.h"
#include "hal/types/robot_model.h"

namespace jaywalk::emulators {

ScannerServer::ScannerServer(std::unique_ptr<ByteServer> wire, const SweepShape& shape, std::size_t beams_per_message,
                             World world)
    : wire_(std::move(wire)),
      shape_(shape),
      beams_per_message_(beams_per_message),
      world_(std::move(world)),
      range_m_(shape.beams),
      says_m_(shape.beams, kMeasures) {}

void ScannerServer::lose_sector(double from_rad, double to_rad, float says_m) {
  constexpr double kSame_rad = 1e-9;
  const BlankedSector sector{from_rad, to_rad};
  for (std::size_t k = 0; k < says_m_.size(); ++k)
    if (sector.off_rad(wrap_angle(shape_.angle_rad(k))) <= kSame_rad) says_m_[k] = says_m;
}

void ScannerServer::order(ScannerFault fault, Duration duration) {
  if (fault_ == ScannerFault::kGone) wire_->set_present(true);
  fault_ = fault;
  fault_lasts_ = duration;
  fault_ends_ = kNever;
}

void ScannerServer::step(Time now) {
  end_fault(now);
  if (fault_ == ScannerFault::kReset) {
    wire_->drop_peer();
    fault_ = ScannerFault::kNone;
  }
  wire_->set_present(fault_ != ScannerFault::kGone);
  serve_peer();
  send_held(now);
  measure(now);
}

// What lasts begins at the first step after it was ordered.
void ScannerServer::end_fault(Time now) {
  const bool lasts =
      fault_ != ScannerFault::kNone && fault_ != ScannerFault::kReset && fault_ != ScannerFault::kHalfTelegram;
  if (!lasts) return;
  if (fault_ends_ == kNever) fault_ends_ = now + fault_lasts_;
  if (now >= fault_ends_) fault_ = ScannerFault::kNone;
}

void ScannerServer::serve_peer() {
  if (!wire_->has_peer()) {
    streaming_ = false;
    return;
  }
  if (wire_->peers() != peers_seen_) {
    peers_seen_ = wire_->peers();
    streaming_ = false;
    on_new_peer();
  }
  const wire::Bytes bytes = wire_->read();
  if (!bytes.empty() && fault_ != ScannerFault::kSilence) on_bytes(bytes);
}

void ScannerServer::measure(Time now) {
  const Duration period = duration_from_seconds(1.0 / shape_.rate_hz);
  const bool paused = began_ == kNever || now - began_ >= 2 * period;
  if (!paused) measure_until_now(now);
  if (!paused && now - began_ < period) return;
  began_ = paused ? now : began_ + period;
  measured_ = told_ = 0;
  measure_until_now(now);
}

void ScannerServer::measure_until_now(Time now) {
  const double share = shape_.sweep > Duration{0} ? to_seconds(now - began_) / to_seconds(shape_.sweep) : 1.0;
  const double past = share * static_cast<double>(shape_.beams - 1);
  const std::size_t until = share >= 1.0 ? shape_.beams : static_cast<std::size_t>(past) + 1;
  if (until <= measured_) return;
  world_(measured_, std::span(range_m_).subspan(measured_, until - measured_));
  for (; measured_ < until; ++measured_)
    if (says_m_[measured_] != kMeasures) range_m_[measured_] = says_m_[measured_];
  tell_measured(now);
}

void ScannerServer::tell_measured(Time now) {
  for (; told_ + beams_per_message_ <= measured_; told_ += beams_per_message_) {
    const Ranges part = Ranges(range_m_).subspan(told_, beams_per_message_);
    if (streaming_) send(message_of(told_, part, began_, now), now);
  }
}

void ScannerServer::send(Message message, Time now) {
  if (noise() < 256.0 * damaged_share_) message[message.size() / 2] ^= 0x5AU;
  switch (fault_) {
    case ScannerFault::kSilence:
    case ScannerFault::kGone: return;
    case ScannerFault::kHalfTelegram: fault_ = ScannerFault::kNone; [[fallthrough]];
    case ScannerFault::kHalves: message.resize(message.size() / 2); break;
    case ScannerFault::kDamage: message[message.size() / 2] ^= 0x5AU; break;
    case ScannerFault::kGarbage:
      for (auto& byte : message) byte = noise();
      break;
    case ScannerFault::kHeldBack: held_.push_back({fault_ends_, std::move(message)}); return;
    case ScannerFault::kDelayed: held_.push_back({now + std::chrono::milliseconds(700), std::move(message)}); return;
    default: break;
  }
  held_.push_back({now + shape_.on_line, std::move(message)});
  send_held(now);
}

void ScannerServer::send_held(Time now) {
  for (; !held_.empty() && held_.front().due <= now; held_.pop_front()) {
    if (!streaming_) continue;  // whom it was meant for is gone
    wire_->write(held_.front().message);
    ++messages_sent_;
  }
}

}  // namespace jaywalk::emulators
