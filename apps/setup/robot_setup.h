#pragma once
// `jaywalk setup`: finds a robot's devices, asks what cannot be seen, and drafts its ROBOT.toml.
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/setup/robot_draft.h"
#include "drivers/can/can_bus.h"
#include "firmware/robot/drive_wiring.h"
#include "firmware/robot/robot_file.h"
#include "hal/hal.h"

namespace jaywalk {

/// Where a scanner may be, and what it may speak there, in the order in which that is tried.
struct ScannerPlace {
  ByteWiring at;  ///< port or baud 0: the maker's
  std::vector<ScannerKind> kinds;
};

struct FoundScanner {
  LaserWiring wiring;
  std::uint32_t beams = 0;
  double fov_deg = 0.0;  ///< from the first beam to the last
  double rate_hz = 0.0;
};

/// Opens all places at once, makes each send by one kind's words, and listens: kind by kind, at most three seconds
/// each. The scanners of which scans came, in the places' order. A name that cannot be resolved has none. Start-up
/// only.
[[nodiscard]] std::vector<FoundScanner> find_scanners(const std::vector<ScannerPlace>& places, Clock& clock);

/// "sick-cola-b at 192.168.0.1:2112: 811 beams over 270.00 degrees, 15 a second"
[[nodiscard]] std::string describe(const FoundScanner& scanner);

/// Nodes by number, and what each said: "vendor 0000029Ch, product 00020192h, ...", or what it was known by.
using FoundNodes = std::map<std::uint8_t, std::string>;

struct FoundDrives {
  std::optional<DriveKind> kind;  ///< none: no drives that this program knows
  FoundNodes nodes;               ///< of that kind
  std::string remark;             ///< what else there is; empty where nothing is
  std::string interface = {};     ///< of CAN; find_drives() does not know it
};

/// Listens for a second: ODrives and VESCs speak by themselves. Where none does, CANopen nodes 1 to 127 are asked what
/// they are (1000h, 1018h); not beside ODrives, to which these questions could be orders (600h + node is axis 48 and
/// up). Nothing is written and nothing moves. Takes about two seconds. Start-up only.
[[nodiscard]] FoundDrives find_drives(CanBus& bus, Clock& clock);
/// Says PULSE, which moves nothing and is SYNC 0 before a connection, at each rate that a Pioneer's board may have.
/// Returns the one at which a whole packet comes back; none: no Pioneer answers. Takes up to three seconds. Start-up
/// only.
[[nodiscard]] std::optional<std::uint32_t> find_pioneer(const std::string& device, Clock& clock);

/// What a machine has that a robot's devices may hang on. Start-up only. Thread: one.
struct Surroundings {
  using Names = std::function<std::vector<std::string>()>;

  Names can_interfaces;  ///< up or down
  Names serial_lines;    ///< by names that do not change
  Names hosts;           ///< addresses at which a scanner may answer: makers' own, and those this machine has spoken to
  Names joysticks;       ///< behind evdev, by names that do not change
  /// All frames of the interface, and the sole right to command there while it is kept. Throws StartupError where it is
  /// down, or another program has it.
  std::function<std::unique_ptr<CanBus>(const std::string& interface)> open_bus;
};

/// This machine: /sys, /dev and the kernel's table of neighbours. `clock` outlives it.
[[nodiscard]] Surroundings this_machine(Clock& clock);

/// Nothing moves, and no device's setting is changed but what makes a scanner send. What the answers name is looked for
/// there alone. Takes some seconds, up to ten. Throws StartupError where the drives or a key are not to be known.
[[nodiscard]] RobotDraft draft_robot(const Surroundings& machine, SetupAnswers& answers, Clock& clock);

}  // namespace jaywalk
