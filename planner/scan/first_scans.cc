#include "planner/scan/first_scans.h"

#include <chrono>
#include <cmath>

namespace jaywalk {
namespace {

constexpr int kFirst = 4;
constexpr double kJumpMps = 0.25, kJumpRadps = 0.3;           // 2 m/s^2 from one scan to the next at 8 Hz
constexpr Duration kSettlesWithin = std::chrono::seconds(1);  // by trial; 1.5 s is no better

}  // namespace

bool FirstScans::are_unreliable(const Twist2& twist, Time now) noexcept {
  if (scans_ < kFirst && ++scans_ > 1) {
    const bool jumped =
        std::fabs(twist.v_mps - last_.v_mps) > kJumpMps || std::fabs(twist.w_radps - last_.w_radps) > kJumpRadps;
    if (jumped) jumped_ = now;
  }
  last_ = twist;
  return jumped_ != kNever && now >= jumped_ && now - jumped_ < kSettlesWithin;
}

}  // namespace jaywalk
