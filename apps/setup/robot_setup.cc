#include "apps/setup/robot_setup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <set>

#include "drivers/laser/scanner_connection.h"
#include "hal/robot_model_file.h"
#include "hal/shown_text.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr const char* kFound = "found";
constexpr const char* kPioneer = "pioneer";
constexpr const char* kMeasured = "measured";  ///< for the name of a model file: its measures are asked for

/// In the order of DriveKind: its name, and the key that says how much a turn of a wheel is.
struct DriveKindKeys {
  const char* kind;
  const char* scale;
};
constexpr std::array<DriveKindKeys, 3> kDriveKinds{{{"cia402", "counts_per_wheel_turn"},
                                                    {"odrive", "motor_turns_per_wheel_turn"},
                                                    {"vesc", "electrical_turns_per_wheel_turn"}}};

std::string listed(const FoundDrives& drives) {
  std::string words;
  for (const auto& [node, said] : drives.nodes)
    words += (words.empty() ? "" : "; ") + std::to_string(int{node}) + ": " + said;
  return words;
}

std::string in_words(const FoundDrives& drives) {
  return drives.interface + ", " + kDriveKinds[static_cast<std::size_t>(*drives.kind)].kind + ": " + listed(drives);
}

/// Without quotes.
std::string text_in(const std::string& literal) { return literal.substr(1, literal.size() - 2); }

std::string model_complaint(const std::string& value) {
  if (value == literal(kMeasured)) return "";
  try {
    static_cast<void>(robot_model(text_in(value)));
    return "";
  } catch (const StartupError& error) {
    return error.what();
  }
}

/// A model's file with its whole path: the robot's file may lie elsewhere.
std::string placed(const std::string& model, const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / text_in(model);
  return std::filesystem::is_regular_file(file) ? literal(std::filesystem::absolute(file).lexically_normal().string())
                                                : model;
}

/// Kinds that are tried on a serial line of which the person named no kind, by its adapter's name. Only to a scanner's
/// adapter anything is sent: an LD19 speaks by itself. CP210x: adapters of LD06, LD19 and RPLIDAR.
std::vector<ScannerKind> kinds_by_adapter(const std::string& line) {
  if (line.find("Hokuyo") != std::string::npos) return {ScannerKind::kHokuyo};
  if (line.find("CP210") != std::string::npos) return {ScannerKind::kLdrobot, ScannerKind::kRplidar};
  return {ScannerKind::kLdrobot};
}

class Setup {
 public:
  Setup(const Surroundings& machine, SetupAnswers& answers, Clock& clock)
      : machine_(machine), answers_(answers), clock_(clock) {}

  RobotDraft draft() {
    draft_.remark(
        "Written by jaywalk setup. Every key: jaywalk config --explain. Next: jaywalk check, commission, run.");
    for (const std::string& table : {laser_section(0), laser_section(1), std::string("drive")})
      if (answers_.given_text(table, "kind") == "dds")
        throw StartupError("setup: looks for devices on wires, not for the topics of a ROS 2 robot",
                           "begin with deploy/config/ros2-control-base.toml");
    look_around();
    draft_model();
    draft_drives();
    draft_scanners();
    draft_panel();
    answers_.finish(draft_);
    return std::move(draft_);
  }

 private:
  /// Before anything is asked: what is there.
  void look_around() {
    const std::string named = answers_.given_text("drive", "can");
    for (const std::string& interface : named.empty() ? machine_.can_interfaces() : std::vector{named})
      look_at(interface);
    answers_.say("Found: " +
                 (drives_.empty() ? "no drives" + (seen_.empty() ? ": no CAN interface" : ": " + seen_) : ""));
    for (const FoundDrives& found : drives_) answers_.say("  " + in_words(found));
    scanners_ = find_scanners(places(laser_section(0)), clock_);
    answers_.say(scanners_.empty() ? "Found: no scanner" : "Found:");
    for (const FoundScanner& found : scanners_) answers_.say("  scanner " + describe(found));
    for (const std::string& joystick : machine_.joysticks()) answers_.say("Found: joystick " + joystick);
  }
  /// One that is measured here lies in a file of its own, the rest of it as the P3-DX has it.
  void draft_model() {
    const bool may_measure = answers_.asks() && !answers_.given("", "model");
    answers_.settle(draft_, "", "model", may_measure ? literal(kMeasured) : "", "", model_complaint);
    const std::string model = draft_.value("", "model");
    if (!may_measure || model != literal(kMeasured))
      return draft_.set("", "model", placed(model, answers_.given("", "model") ? answers_.folder() : ""),
                        "as answered");
    const RobotModel like = p3dx();
    std::string text = "# Measured by a person; what is not was taken from the P3-DX: see to it.\n";
    const auto ask = [&](const char* section, std::initializer_list<const char*> keys) {
      text += std::string("\n[") + section + "]\n";
      for (const char* key : keys)
        text += std::string(key) + " = " + answers_.ask(robot_model_keys().find(section, key), section) + "\n";
    };
    const auto take = [&text](const char* key, double value) {
      text += std::string(key) + " = " + literal(value) + "\n";
    };
    ask("footprint", {"front_m", "rear_m", "half_width_m"});
    ask("drive", {"wheel_radius_m", "track_width_m", "max_wheel_speed_radps"});
    text += "\n[limits]\n";
    take("max_speed_mps", like.limits.max_speed_mps), take("max_turn_radps", like.limits.max_turn_radps);
    take("max_accel_mps2", like.limits.max_accel_mps2),
        take("max_turn_accel_radps2", like.limits.max_turn_accel_radps2);
    take("max_jerk_mps3", like.limits.max_jerk_mps3), take("brake_mps2", like.limits.brake_mps2);
    text += "\n[laser]\n";  // robot.toml says better
    take("fov_deg", std::floor(like.laser.fov_rad * 180.0 / kPi)), take("rate_hz", like.laser.rate_hz);
    take("beams", like.laser.beams), take("range_min_m", like.laser.range_min_m),
        take("range_m", like.laser.range_max_m);
    take("noise_m", like.laser.noise_m), take("drop_out", like.laser.drop_out);
    text += "mount = [0.0, 0.0, 0.0]\n";
    draft_.set_model(text);
  }
  /// Looks on the line that the answers name, else on each without a scanner: only where a person spoke of a Pioneer.
  void draft_pioneer() {
    answers_.take_kind(kPioneer);
    answers_.settle(draft_, "drive", "ticks_per_mm", "128", "a P3-DX's; jaywalk check compares it");
    if (answers_.given("drive", "host")) return;
    const std::string named = answers_.given_text("drive", "device");
    for (const std::string& line : named.empty() ? machine_.serial_lines() : std::vector{named}) {
      const auto has_line = [&line](const FoundScanner& scanner) { return name_of(scanner.wiring) == line; };
      const auto baud = std::ranges::any_of(scanners_, has_line) ? std::nullopt : find_pioneer(line, clock_);
      if (!baud) continue;
      answers_.say("Found: a Pioneer's board at " + line);
      draft_.set("drive", "device", literal(line), kFound);
      return draft_.set("drive", "baud", std::to_string(*baud), kFound);
    }
    draft_.remark("No Pioneer answered.");
    answers_.settle(draft_, "drive", "device");
  }
  void draft_drives() {
    if (drives_.empty()) return draft_absent_drives();
    std::vector<std::string> words;
    for (const FoundDrives& found : drives_) words.push_back(in_words(found));
    enter_drives(drives_[answers_.choose("drives", words)]);
  }
  /// A file for drives that are somewhere else, or off: as a person knows them.
  void draft_absent_drives() {
    if (!answers_.asks() && answers_.given_text("drive", "kind").empty())
      throw StartupError("setup: no drives were found" + (seen_.empty() ? ": no CAN interface" : ": " + seen_),
                         "see to power, wires and bit rate, or answer drive.kind, can, left_node and right_node");
    answers_.settle(draft_, "drive", "kind", literal(kDriveKinds[0].kind));
    const std::string kind = draft_.value("drive", "kind");
    if (kind == literal(kPioneer)) return draft_pioneer();
    draft_.remark("No drive answered" + (seen_.empty() ? ": no CAN interface." : ": " + seen_));
    const auto keys = std::ranges::find_if(kDriveKinds, [&](const auto& each) { return literal(each.kind) == kind; });
    if (keys == kDriveKinds.end())
      throw StartupError("setup: drive.kind is answered as " + kind, "choose cia402, odrive, vesc or pioneer");
    answers_.take_kind(keys->kind);
    answers_.settle(draft_, "drive", "can", literal("can0"), "a guess");
    draft_wheels(*keys, "", "");
  }
  void look_at(const std::string& interface) {
    std::string said = interface + ": no drive answers";
    try {
      const std::unique_ptr<CanBus> bus = machine_.open_bus(interface);
      FoundDrives drives = find_drives(*bus, clock_);
      if (!drives.remark.empty()) draft_.remark(said = interface + ": " + drives.remark);
      drives.interface = interface;
      if (drives.kind) return drives_.push_back(std::move(drives));
    } catch (const StartupError& error) {
      said = error.what();
    }
    seen_ += (seen_.empty() ? "" : "; ") + said;
  }
  void enter_drives(const FoundDrives& drives) {
    const DriveKindKeys& keys = kDriveKinds[static_cast<std::size_t>(*drives.kind)];
    std::vector<std::string> numbers;
    for (const auto& [node, said] : drives.nodes) {
      numbers.push_back(std::to_string(int{node}));
      draft_.remark(drives.interface + " " + keys.kind + " " + numbers.back() + ": " + said);
    }
    if (const std::string named = answers_.given_text("drive", "kind"); !named.empty() && named != keys.kind)
      throw StartupError(
          "setup: drive.kind is answered as " + named + ", and " + drives.interface + " has " + keys.kind,
          "correct the answer, or see which drives are on that bus");
    draft_.set("drive", "kind", literal(keys.kind), kFound);
    draft_.set("drive", "can", literal(drives.interface), kFound);
    answers_.take_kind(keys.kind);
    if (numbers.size() < 2)
      throw StartupError("setup: " + drives.interface + " has one drive, " + listed(drives), "connect both");
    if (numbers.size() > 2) numbers.assign(2, "");
    draft_wheels(keys, numbers[0], numbers[1]);
  }
  void draft_wheels(const DriveKindKeys& keys, const std::string& left, const std::string& right) {
    constexpr const char* kGuess = "found; which side it is on shows jaywalk commission";
    answers_.settle(draft_, "drive", "left_node", left, kGuess);
    answers_.settle(draft_, "drive", "right_node", right, kGuess);
    answers_.settle(draft_, "drive", keys.scale);
    answers_.settle(draft_, "drive", "left_reversed", "false", "a guess; jaywalk commission shows it");
    answers_.settle(draft_, "drive", "right_reversed", "true",
                    "a guess: its motor looks the other way; see commission");
  }

  /// Where a scanner may be: what the answers name, else everywhere.
  [[nodiscard]] std::vector<ScannerPlace> places(const std::string& section) {
    const std::string kind = answers_.given_text(section, "kind"), host = answers_.given_text(section, "host"),
                      device = answers_.given_text(section, "device");
    const auto asked = [&kind](std::vector<ScannerKind> otherwise) {
      const auto named = scanner_kind(kind);
      return named ? std::vector{*named} : std::move(otherwise);
    };
    const auto number = [&](const char* key) {
      return static_cast<std::uint32_t>(std::stoul(answers_.given(section, key).value_or("0")));
    };
    const auto port = static_cast<std::uint16_t>(number("port"));
    const std::uint32_t baud = number("baud");
    using enum ScannerKind;
    if (!host.empty()) return {{{host, port, "", 0}, asked({kSickColaB, kSickColaA, kHokuyo})}};
    if (!device.empty()) return {{{"", 0, device, baud}, asked({kLdrobot, kRplidar, kHokuyo, kLms200})}};
    std::vector<ScannerPlace> places;
    for (const std::string& each : machine_.hosts()) {
      places.push_back({{each, port, "", 0}, {kSickColaB, kSickColaA}});
      places.push_back({{each, port, "", 0}, {kHokuyo}});
    }
    for (const std::string& line : machine_.serial_lines())
      places.push_back({{"", 0, line, baud}, asked(kinds_by_adapter(line))});
    return places;
  }
  /// Drafts every scanner of the answers, at least one. At a terminal it asks about each further scanner that was
  /// found.
  void draft_scanners() {
    std::size_t count = 0;
    do draft_scanner(laser_section(count++));
    while (count < answers_.scanners() || (others_answer_ && answers_.agrees("Has the robot a further scanner?")));
  }
  void draft_scanner(const std::string& section) {
    const bool is_first = section == laser_section(0);
    std::vector<FoundScanner> scanners = is_first ? scanners_ : find_scanners(places(section), clock_);
    std::erase_if(scanners, [this](const FoundScanner& each) { return taken_.contains(name_of(each.wiring)); });
    others_answer_ = scanners.size() > 1;
    std::vector<std::string> words;
    for (const FoundScanner& scanner : scanners) words.push_back(describe(scanner));
    for (const std::string& word : words) draft_.remark("scanner " + word);
    if (scanners.empty())
      draft_absent_scanner(section);
    else
      enter_scanner(section, scanners[answers_.choose(section, words)]);
    if (!is_first || answers_.asks() || answers_.given(section, "mount"))
      answers_.settle(draft_, section, "mount", is_first ? "[0.0, 0.0, 0.0]" : "");
  }
  /// A person may know where it is, and it may answer there.
  void draft_absent_scanner(const std::string& section) {
    answers_.settle(draft_, section, "kind", "", "", [](const std::string& kind) {
      return kind == literal("dds") ? "for a ROS 2 robot begin with deploy/config/ros2-control-base.toml" : "";
    });
    const bool is_placed = answers_.given(section, "host") || answers_.given(section, "device");
    if (!is_placed && !answers_.asks())
      throw StartupError("setup: no scanner was found", "see to its power and address, or name laser.host or .device");
    const ScannerMake& make = *std::ranges::find_if(scanner_makes(), [&](const ScannerMake& each) {
      return literal(std::string(each.name)) == draft_.value(section, "kind");
    });
    ScannerPlace place;
    place.kinds = {make.kind};
    if (!is_placed && make.port != 0 && (make.baud == 0 || answers_.agrees("Is the scanner on the network?"))) {
      answers_.settle(draft_, section, "host");
      answers_.settle(draft_, section, "port", std::to_string(make.port));
      place.at.host = text_in(draft_.value(section, "host"));
      place.at.port = static_cast<std::uint16_t>(std::stoul(draft_.value(section, "port")));
    } else if (!is_placed) {
      answers_.settle(draft_, section, "device");
      place.at.device = text_in(draft_.value(section, "device"));
    }
    const std::vector<FoundScanner> found = is_placed ? std::vector<FoundScanner>{} : find_scanners({place}, clock_);
    if (!found.empty()) return answers_.say("Found: scanner " + describe(found[0])), enter_scanner(section, found[0]);
    answers_.say("No scanner answers there yet.");
    draft_.remark("No scanner answered.");
  }
  void enter_scanner(const std::string& section, const FoundScanner& scanner) {
    taken_.insert(name_of(scanner.wiring));
    const auto enter = [&](const char* key, const std::string& value) {
      if (!answers_.given(section, key)) draft_.set(section, key, value, kFound);
    };
    const LaserWiring& wiring = scanner.wiring;
    enter("kind", literal(std::string(scanner_make(wiring.kind).name)));
    if (wiring.host.empty()) {
      enter("device", literal(wiring.device));
      enter("baud", std::to_string(wiring.baud));
    } else {
      enter("host", literal(wiring.host));
      enter("port", std::to_string(wiring.port));
    }
    enter("beams", std::to_string(scanner.beams));
    enter("fov_deg", formatted("%.2f", scanner.fov_deg));
    enter("rate_hz", literal(scanner.rate_hz));
  }

  /// A stick that is plugged in is not yet wished for: it can stop the robot.
  void draft_panel() {
    const std::vector<std::string> joysticks = machine_.joysticks();
    for (const std::string& joystick : joysticks) draft_.remark("joystick " + joystick);
    if (joysticks.empty()) return;
    if (!answers_.has_section("panel") && !answers_.agrees("Is a joystick to be the robot's panel?")) return;
    if (!answers_.given("panel", "joystick"))
      draft_.set("panel", "joystick", literal(joysticks[answers_.choose("panel", joysticks)]), kFound);
    answers_.settle(draft_, "panel", "needs_dead_man", "true", "the default");
  }

  const Surroundings& machine_;
  SetupAnswers& answers_;
  Clock& clock_;
  RobotDraft draft_;
  std::vector<FoundDrives> drives_;
  std::string seen_;  ///< on interfaces without drives
  std::vector<FoundScanner> scanners_;
  std::set<std::string> taken_;  ///< places of the scanners in the draft
  bool others_answer_ = false;   ///< a scanner was found that the draft does not have
};

}  // namespace

RobotDraft draft_robot(const Surroundings& machine, SetupAnswers& answers, Clock& clock) {
  return Setup(machine, answers, clock).draft();
}

}  // namespace jaywalk
