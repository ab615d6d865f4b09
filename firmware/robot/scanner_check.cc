#include "firmware/robot/scanner_check.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "firmware/robot/robot_devices.h"
#include "firmware/safety/blind_gaps.h"
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

/// "[[laser.blanked]] from_deg = 10.5, to_deg = 14.0" and so on: the beams that end on the robot, and the next ones.
std::string sectors_on_body(const StopZone& zone, const LaserScan& scan) {
  constexpr double kDegPerRad = 180.0 / kPi;
  const double step_deg = static_cast<double>(scan.angle_step_rad) * kDegPerRad;
  std::string sectors;
  for (std::size_t beam = 0; beam < scan.beam_count; ++beam) {
    if (!zone.is_on_body(scan, beam)) continue;
    const double first_deg = scan.angle_rad(beam) * kDegPerRad - step_deg;
    while (beam + 1 < scan.beam_count && zone.is_on_body(scan, beam + 1)) ++beam;
    const double last_deg = scan.angle_rad(beam) * kDegPerRad + step_deg;
    char sector[80];
    std::snprintf(sector, sizeof sector, " [[laser.blanked]] from_deg = %.1f, to_deg = %.1f",
                  std::min(first_deg, last_deg), std::max(first_deg, last_deg));
    sectors += sector;
  }
  return sectors;
}

void require_free_body(const std::string& said, const LaserScan& scan, const Footprint& body, const Pose2& mount) {
  const StopZone zone({.footprint = body, .robot_from_laser = mount});
  const std::size_t on_body = zone.beams_on_body(scan);
  if (on_body == 0) return;
  throw StartupError(said + ", " + std::to_string(on_body) + " of the beams end within the robot's own outline",
                     "take away what is before it, or correct [laser] mount or the model's footprint; for what belongs "
                     "there write" +
                         sectors_on_body(zone, scan));
}

/// Throws where the loop would take the sight for lost by and by.
void require_sight(const std::string& said, const LaserScan& scan, const LaserModel& laser) {
  BlindGaps gaps(laser);
  gaps.update(scan);
  const BeamCounts& counts = gaps.counts();
  SightLoss sight;
  const bool at_once = sight.is_lost(counts, Time{}), in_time = sight.is_lost(counts, Time{std::chrono::minutes(1)});
  if (!at_once && !in_time) return;
  throw StartupError(said + ", " + std::to_string(counts.lost) + " of the beams measured nothing, " +
                         std::to_string(counts.lost_ahead) + " of them ahead",
                     "clean its window, take away what covers it, or shade it");
}

}  // namespace

std::string check_scanner(const RobotFile& file, Clock& clock, std::size_t scanner) {
  const std::unique_ptr<ScannerConnection> laser = make_laser(file, clock, scanner);
  const LaserModel& model = file.setup.model.lasers()[scanner];
  await_first_scan(*laser, file, clock, scanner);
  const std::uint32_t before = laser->latest().sequence;
  clock.sleep_until(clock.now() + kRateSpan);
  LaserScan scan = laser->latest();
  blank(model.blanked, scan);
  const double rate_hz = (scan.sequence - before) / to_seconds(kRateSpan);
  char figures[100];
  std::snprintf(figures, sizeof figures, ": %u beams, %.0f scans a second", static_cast<unsigned>(scan.beam_count),
                rate_hz);
  const std::string said = laser->name() + figures;
  require_free_body(said, scan, file.setup.model.footprint, model.robot_from_laser);
  require_sight(said, scan, model);
  require_rate(said, rate_hz, model.rate_hz);
  return said;
}

}  // namespace jaywalk
