#include "hil/faults/fault_matrix.h"

#include <array>

#include "hal/text_file.h"

namespace jaywalk::faults {
namespace {

constexpr std::array kKinds{DriveKind::kCia402, DriveKind::kOdrive, DriveKind::kVesc, DriveKind::kPioneer};
constexpr std::array kSpeeds_mps{0.3, 0.6, 1.2};

template <class Visit>
void for_each_row(Visit&& visit) {
  for (const FaultCase& fault : all_cases()) {
    for (const DriveKind kind : kKinds) {
      if (fault.only && *fault.only != kind) continue;
      if (fault.of_bus && kind == DriveKind::kPioneer) continue;
      for (const double speed : kSpeeds_mps) visit(fault, kind, speed);
    }
  }
}

constexpr double kLong_m = 44.0, kWide_m = 5.0;

/// The drive's own keys; counts, turns and pole pairs are those of the bench's motors. A Pioneer has its factory's
/// cycle.
std::string drive_keys(DriveKind kind) {
  if (kind == DriveKind::kPioneer) return "device = \"in-process\"\nticks_per_mm = 128\n";
  const std::string can = "can = \"in-process\"\nright_reversed = true\n";
  if (kind == DriveKind::kOdrive) return can + "left_node = 3\nright_node = 4\nmotor_turns_per_wheel_turn = 10\n";
  if (kind == DriveKind::kVesc) return can + "left_node = 23\nright_node = 24\nelectrical_turns_per_wheel_turn = 50\n";
  return can + "left_node = 2\nright_node = 3\ncounts_per_wheel_turn = 76600\n";
}

/// A P3-DX (hal/types/robot_model.h) as a file, with a fastest speed of its own.
std::string model_text(double speed_mps) {
  return "name = \"matrix\"\n"
         "[footprint]\nfront_m = 0.210\nrear_m = 0.301\nhalf_width_m = 0.2125\n"
         "[drive]\nwheel_radius_m = 0.0975\ntrack_width_m = 0.33\nmax_wheel_speed_radps = 14.0\n"
         "[limits]\nmax_speed_mps = " +
         std::to_string(speed_mps) +
         "\nmax_turn_radps = 1.5\nmax_accel_mps2 = 0.5\nmax_turn_accel_radps2 = 3.0\nmax_jerk_mps3 = 2.0\n"
         "brake_mps2 = 1.0\n"
         "[laser]\nmount = [0.0, 0.0, 0.0]\nfov_deg = 270.0\nbeams = 541\nrate_hz = 15.0\nrange_min_m = 0.05\n"
         "range_m = 50.0\n";  // across the hall: a SICK has no word for "nothing in reach" that proves it
}

}  // namespace

int run_matrix(double rate_hz, const std::filesystem::path& folder,
               const std::function<void(const FaultResult&)>& tell) {
  int bad = 0;
  for_each_row([&](const FaultCase& fault, DriveKind kind, double speed_mps) {
    const FaultResult result = FaultBench(fault, kind, speed_mps, rate_hz, folder).suffer();
    bad += result.why_not.empty() ? 0 : 1;
    tell(result);
  });
  return bad;
}

const char* name_of(DriveKind kind) noexcept {
  constexpr std::array kNames{"cia402", "odrive", "vesc", "dds", "pioneer"};
  return kNames.at(static_cast<std::size_t>(kind));
}

RobotFile robot_file(const FaultCase& fault, DriveKind kind, double speed_mps, double rate_hz,
                     const std::filesystem::path& folder) {
  const std::string scans = fault.claims_free ? "\"hokuyo\"\nbeams = 1081\nrange_m = 30.0\n" : "\"sick-cola-b\"\n";
  const std::string scanner = "[[laser]]\nhost = \"127.0.0.1\"\nkind = " + scans;
  write_text(folder / "model.toml", model_text(speed_mps), kOtherOut);
  write_text(folder / "robot.toml",
             std::string("model = \"model.toml\"\nstart = [1.5, 2.5, 0.0]\nrate_hz = ") + std::to_string(rate_hz) +
                 "\n" + scanner +
                 (fault.of_two ? scanner + "port = 2113\nmount = [-0.2, 0.0, 3.14159]\nrate_hz = 20.0\n" : "") +
                 "[drive]\nkind = \"" + name_of(kind) + "\"\n" + drive_keys(kind),
             kOtherOut);
  RobotFile file = load_robot_file(folder / "robot.toml");
  file.setup.backend = Backend::kCpu;
  return file;
}

sim::Scenario hall(const RobotModel& model, const std::filesystem::path& folder) {
  const std::string far = std::to_string(static_cast<int>(1000.0 * kLong_m));
  const std::string left = std::to_string(static_cast<int>(1000.0 * kWide_m));
  write_text(folder / "hall.map",
             "2D-Map\nNumLines: 4\nLINES\n0 0 " + far + " 0\n" + far + " 0 " + far + " " + left + "\n" + far + " " +
                 left + " 0 " + left + "\n0 " + left + " 0 0\nDATA\n",
             kOtherOut);
  sim::Scenario scenario;
  scenario.name = "hall";
  scenario.map_kind = sim::MapKind::kAria;
  scenario.map_file = folder / "hall.map";
  scenario.model = model;
  scenario.model.laser.noise_m = 0.01;
  scenario.start = {1.5, 0.5 * kWide_m, 0.0};
  scenario.goal = {kLong_m - 2.0, 0.5 * kWide_m};
  return scenario;
}

}  // namespace jaywalk::faults
