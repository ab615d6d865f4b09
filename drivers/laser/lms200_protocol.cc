#include "drivers/laser/lms200_protocol.h"

namespace jaywalk::lms200 {

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
