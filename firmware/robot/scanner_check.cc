#include "firmware/robot/scanner_check.h"

#include <cmath>
#include <cstdio>

#include "firmware/robot/robot_devices.h"
#include "firmware/safety/stop_zone.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr Duration kRateSpan = std::chrono::seconds(1);
constexpr double kRateTolerance = 0.1;

void require_rate(const std::string& said, double rate_hz, double wanted_hz) {
  // One more or fewer may fall into the span.
  if (std::fabs(rate_hz - wanted_hz) > std::fmax(kRateTolerance * wanted_hz, 1.0))
    throw StartupError(said, "correct [laser] rate_hz, or set the scanner's");
}

void require_free_body(const std::string& said, const LaserScan& scan, const RobotModel& model) {
  const StopZone zone({.footprint = model.footprint, .robot_from_laser = model.laser.robot_from_laser});
  const std::size_t on_body = zone.beams_on_body(scan);
  if (on_body == 0) return;
  throw StartupError(said + ", " + std::to_string(on_body) + " of the beams end within the robot's own outline",
                     "take away what is before it, or correct [laser] mount or the model's footprint; what belongs "
                     "there needs a [laser] range_min_m above its distance");
}

}  // namespace

std::string check_scanner(const RobotFile& file, Clock& clock) {
  const std::unique_ptr<ScannerConnection> laser = make_laser(file, clock);
  await_first_scan(*laser, file, clock);
  const std::uint32_t before = laser->latest().sequence;
  clock.sleep_until(clock.now() + kRateSpan);
  const LaserScan& scan = laser->latest();
  const double rate_hz = (scan.sequence - before) / to_seconds(kRateSpan);
  char figures[100];
  std::snprintf(figures, sizeof figures, ": %u beams, %.0f scans a second", static_cast<unsigned>(scan.beam_count),
                rate_hz);
  const std::string said = laser->name() + figures;
  require_free_body(said, scan, file.setup.model);
  require_rate(said, rate_hz, file.setup.model.laser.rate_hz);
  return said;
}

}  // namespace jaywalk
