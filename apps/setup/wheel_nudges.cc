#include "apps/setup/wheel_nudges.h"

#include <cmath>

#include "apps/setup/watched_drive.h"

namespace jaywalk {
namespace {

constexpr Duration kLongestNudge = std::chrono::seconds(5);

class Nudging {
 public:
  Nudging(const NudgeSetup& setup, WiredDrive& drive, std::span<LaserScanner* const> lasers, Clock& clock,
          const std::function<bool()>& stopped)
      : setup_(setup), drive_({"commissioning", setup.model, setup.tick}, drive, lasers, clock, stopped) {}

  Nudge nudge(std::size_t side, double sign) {
    Nudge nudge{.side = side, .sign = sign};
    drive_.rest();
    nudge.before = drive_.wheels();
    nudge.scans_before = drive_.scans();
    const Time limit = drive_.due() + kLongestNudge;
    while (!nudge.disobeyed && rolled_m(nudge) < setup_.way_m && drive_.due() < limit) {
      require_room();
      const double radps = sign * setup_.speed_mps / setup_.model.drive.wheel_radius_m;
      nudge.disobeyed = !drive_.tick(side == 0 ? radps : 0.0, side == 1 ? radps : 0.0);
    }
    drive_.rest();
    nudge.after = drive_.wheels();
    nudge.scans_after = drive_.scans();
    nudge.response_s = drive_.response_s();
    return nudge;
  }

 private:
  [[nodiscard]] double rolled_m(const Nudge& nudge) const {
    const WheelState& now = drive_.wheels();
    const double turned =
        nudge.side == 0 ? now.left_rad - nudge.before.left_rad : now.right_rad - nudge.before.right_rad;
    return std::fabs(turned) * setup_.model.drive.wheel_radius_m;
  }
  /// Wherever wrong wiring may make it go.
  void require_room() {
    const double v = 0.5 * setup_.speed_mps, w = setup_.speed_mps / setup_.model.drive.track_width_m;
    for (const Twist2& way : {Twist2{v, w}, Twist2{v, -w}, Twist2{-v, w}, Twist2{-v, -w}}) {
      if (!drive_.has_room(way))
        drive_.give_up("something stands too near", "leave half a metre free all round the robot");
    }
  }

  const NudgeSetup& setup_;
  WatchedDrive drive_;
};

}  // namespace

std::vector<Nudge> nudge_wheels(const NudgeSetup& setup, WiredDrive& drive, std::span<LaserScanner* const> lasers,
                                Clock& clock, const std::function<bool()>& stopped) {
  Nudging nudging(setup, drive, lasers, clock, stopped);
  std::vector<Nudge> nudges;
  for (const std::size_t side : {0U, 1U}) {
    for (const double sign : {1.0, -1.0}) {
      nudges.push_back(nudging.nudge(side, sign));
      if (nudges.back().disobeyed) return nudges;
    }
  }
  return nudges;
}

}  // namespace jaywalk
