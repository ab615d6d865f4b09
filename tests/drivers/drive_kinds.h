#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/drivers/drive_bench.h"
#include "tests/drivers/random_bytes.h"

namespace jaywalk::tests {

/// What a test changes of a kind's setup.
struct BenchChanges {
  bool allow_unproved = false;
  Duration tick = std::chrono::milliseconds(20);
  std::optional<std::array<std::uint8_t, 2>> ids = {};
  std::optional<double> per_rad = {};
};

/// Something happens to the drive on a side (0 left, 1 right).
using DriveEvent = std::function<void(DriveBench&, std::size_t side)>;

/// A row of the table: a kind of drive, its rates, and how what may happen to any drive happens to it.
struct DriveKind {
  const char* name;
  std::unique_ptr<DriveBench> (*make)(const BenchChanges& changes);
  std::optional<std::uint8_t> reserved_id =
      {};  ///< no drive may have it; none of a board alone on its line, without ids
  double brake_radps2, tolerance_radps = 0.5;
  double travelled_rad;              ///< by bring_to_two_radps()
  int enabling_ticks, stop_ticks;    ///< most from zero to torque; from trouble at 2 rad/s to a wheel that stands
  int proof_ticks;                   ///< most that a proof takes
  int absent_ticks, given_up_ticks;  ///< least and most that a proof waits for a drive that is away
  int disarm_ticks;
  Duration own_stop;          ///< most from two ticks after the last command until a wheel at 2 rad/s stands
  Duration noticed;           ///< most until a drive that tells nothing is noticed, beside what a stop has
  bool brakes_itself = true;  ///< its watch over the controller brakes; otherwise it takes the torque away
  DriveTrouble fault = DriveTrouble::kDriveFault;          ///< what break_down() is called
  DriveTrouble restarted = DriveTrouble::kDriveRestarted;  ///< what a restart is called
  std::string broken;                                      ///< how its fault is told; of the right drive
  DriveEvent break_down, mend;
  DriveEvent lose_watch, restore_watch;  ///< over the controller, in a way that its proof must find
  DriveEvent need_restart;               ///< it stops obeying or talking until it is restarted and plugged in
  std::vector<DriveEvent> disobey;       ///< goes on at its speed when told zero, yet is fed
  std::vector<DriveEvent> fall_quiet;    ///< tells its speed no more
  DriveEvent jump;                       ///< its position is another one at once, by 100 rad of the wheel
  std::string unproved, remedy;          ///< what arming says where the left drive lost its watch
  std::vector<CanFrame> second_way;      ///< frames of an emergency brake
  std::string foreign = {};              ///< how arming names another master
  std::vector<CanFrame> masters = {};    ///< frames that only another master sends
  std::vector<CanFrame> strangers = {};  ///< frames of others that mean neither drive
  CanFrame (*random_frame)(RandomBytes& random);
};

/// CiA 402, ODrive, VESC, Pioneer: what a test of all drives goes through.
[[nodiscard]] const std::vector<DriveKind>& drive_kinds();

/// `body(kind, bench)` for each kind, on a bench of its own. No sections: of those in a loop only the first turn runs.
template <class Body>
void with_each_kind(Body body, const BenchChanges& changes = {}) {
  for (const DriveKind& kind : drive_kinds()) {
    CAPTURE(kind.name);
    const auto bench = kind.make(changes);
    body(kind, *bench);
  }
}

/// `body(kind, bench, side)` for each kind and either side.
template <class Body>
void with_each_side(Body body) {
  for (const std::size_t side : {0U, 1U}) {
    CAPTURE(side);
    with_each_kind([&](const DriveKind& kind, DriveBench& bench) { body(kind, bench, side); });
  }
}

}  // namespace jaywalk::tests
