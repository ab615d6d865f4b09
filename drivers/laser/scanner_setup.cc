#include "drivers/laser/scanner_setup.h"

#include <algorithm>
#include <array>

#include "drivers/laser/ldrobot.h"
#include "drivers/laser/lms200.h"
#include "drivers/laser/rplidar.h"
#include "drivers/laser/scip.h"
#include "drivers/laser/sick.h"
#include "drivers/ros/ros_scan.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

constexpr std::array<ScannerMake, 7> kKinds{{{"sick-cola-a", ScannerKind::kSickColaA, 2112, 0},
                                             {"sick-cola-b", ScannerKind::kSickColaB, 2112, 0},
                                             {"hokuyo", ScannerKind::kHokuyo, 10940, 115200},
                                             {"ld19", ScannerKind::kLdrobot, 0, 230400},
                                             {"lms200", ScannerKind::kLms200, 0, 9600},
                                             {"rplidar", ScannerKind::kRplidar, 0, 115200},
                                             {"dds", ScannerKind::kDds, 0, 0}}};

std::unique_ptr<wire::Link> link_of(const ScannerSetup& setup, const ScannerMake& kind, std::uint32_t baud) {
  if (setup.kind == ScannerKind::kDds) return std::make_unique<ros::RingLink>(setup.device, setup.topic);
  const bool on_network = !setup.host.empty();
  if (on_network == !setup.device.empty()) {
    throw StartupError("scanner: " + std::string(on_network ? "both host and device" : "neither host nor device"),
                       "give the host of one on a network, or the device of one on a serial line");
  }
  if (on_network && kind.port == 0)
    throw StartupError(setup.host + ": " + std::string(kind.name) + " is not on a network", "give its serial device");
  if (!on_network && kind.baud == 0)
    throw StartupError(setup.device + ": " + std::string(kind.name) + " is not on a serial line", "give its host");
  return wire::make_byte_link(setup.host, setup.port == 0 ? kind.port : setup.port, setup.device, baud);
}

std::unique_ptr<ScannerProtocol> protocol_of(const ScannerSetup& setup, std::uint32_t baud) {
  const sick::ScannerModel model{.range_min_m = setup.range_min_m, .range_max_m = setup.range_max_m};
  switch (setup.kind) {
    case ScannerKind::kSickColaA: return std::make_unique<sick::SickProtocol>(sick::Cola::kA, model);
    case ScannerKind::kSickColaB: return std::make_unique<sick::SickProtocol>(sick::Cola::kB, model);
    case ScannerKind::kHokuyo: return std::make_unique<scip::ScipProtocol>();
    case ScannerKind::kLdrobot: return std::make_unique<ldrobot::LdProtocol>();
    case ScannerKind::kLms200: return std::make_unique<lms200::Lms200Protocol>(baud);
    case ScannerKind::kRplidar: return std::make_unique<rplidar::RplidarProtocol>();
    case ScannerKind::kDds: return std::make_unique<ros::RosScanProtocol>(setup.infinity_is_free);
  }
  throw StartupError("scanner: of no known kind", "choose one of those in drivers/laser/scanner_setup.h");
}

}  // namespace

std::span<const ScannerMake> scanner_makes() noexcept { return kKinds; }

const ScannerMake& scanner_make(ScannerKind kind) noexcept {
  return *std::find_if(kKinds.begin(), kKinds.end(), [kind](const ScannerMake& k) { return k.kind == kind; });
}

std::optional<ScannerKind> scanner_kind(std::string_view name) noexcept {
  const auto* const found =
      std::find_if(kKinds.begin(), kKinds.end(), [name](const ScannerMake& k) { return k.name == name; });
  return found == kKinds.end() ? std::nullopt : std::optional(found->kind);
}

std::unique_ptr<ScannerConnection> make_scanner(const ScannerSetup& setup, Clock& clock) {
  const ScannerMake& kind = scanner_make(setup.kind);
  const std::uint32_t baud = setup.baud == 0 ? kind.baud : setup.baud;
  return std::make_unique<ScannerConnection>(link_of(setup, kind, baud), protocol_of(setup, baud), clock);
}

}  // namespace jaywalk
