#include "drivers/canopen/drive_settings.h"

#include <array>
#include <cassert>
#include <initializer_list>

#include "drivers/canopen/cia402.h"
#include "drivers/canopen/services.h"

namespace jaywalk::canopen {

namespace {

constexpr std::uint8_t kAtEverySync = 1;
constexpr unsigned kIsMapping = 0x200;  ///< sets 1600h and 1A00h apart from 1400h and 1800h
constexpr std::uint32_t kHasProfileVelocity = 1U << 2U;

// Option codes of CiA 402: 6007h 3 is quick stop; 605Ah 2 brakes by 6085h, then switches off; 605Bh, 605Ch and 605Dh 1
// brake by 6084h; 605Eh 2 brakes by 6085h.
constexpr std::uint32_t kLostControllerQuickStops = 3, kQuickStopThenOff = 2, kBrakeThenOff = 1, kBrake = 1,
                        kFaultQuickStops = 2;

PdoSetup setup(std::uint16_t communication, std::uint16_t mapping, std::uint32_t id,
               std::initializer_list<MappedObject> objects) noexcept {
  PdoSetup made{communication, mapping, id, kAtEverySync, {}};
  for (const MappedObject& object : objects) {
    const bool fits = made.mapping.push_back(object);
    assert(fits);
    static_cast<void>(fits);
  }
  return made;
}

}  // namespace

PdoSetup command_pdo(std::uint8_t node) noexcept {
  return setup(0x1400, 0x1600, 0x200U + node, {{kControlword, 2}, {kTargetVelocity, 4}});
}

PdoSetup status_pdo(std::uint8_t node) noexcept {
  return setup(0x1800, 0x1A00, 0x180U + node, {{kStatusword, 2}, {kVelocity, 4}, {kModeShown, 1}});
}

PdoSetup position_pdo(std::uint8_t node) noexcept { return setup(0x1801, 0x1A01, 0x280U + node, {{kPosition, 4}}); }

// Its mode shows in 6061h once it is enabled, of many drives no sooner: WheelAxis holds it against the drive then.
ArmingProof::Items behaviour_items(const DriveSettings& settings) noexcept {
  const std::uint32_t watch = heartbeat_consumer_entry(settings.controller_node, settings.controller_timeout_ms);
  ArmingProof::Items items;
  bool fits = true;
  const auto need = [&](ObjectWrite wanted, const char* what_for, bool to_drive = false) {
    fits = fits && items.push_back({wanted, ProofDemand::kWritten, what_for, to_drive});
  };
  need({{0x1016, 1}, watch, 4}, "watches the controller's heartbeat");
  need({{0x1017, 0}, settings.heartbeat_ms, 2}, "says its own heartbeat", true);
  need({kAbortConnection, kLostControllerQuickStops, 2}, "stops when the controller is lost");
  need({kQuickStopOption, kQuickStopThenOff, 2}, "quick stop");
  need({kShutdownOption, kBrakeThenOff, 2}, "brakes at shutdown");
  need({kDisableOption, kBrakeThenOff, 2}, "brakes when disabled");
  need({kHaltOption, kBrake, 2}, "brakes at halt");
  need({kFaultOption, kFaultQuickStops, 2}, "brakes at a fault");
  need({kProfileAcceleration, settings.acceleration, 4}, "acceleration");
  need({kProfileDeceleration, settings.deceleration, 4}, "deceleration");
  need({kQuickStopDeceleration, settings.quick_stop, 4}, "quick stop deceleration");
  need({kModeWanted, kProfileVelocityMode, 1}, "profile velocity", true);
  assert(fits);
  static_cast<void>(fits);
  return items;
}

ArmingProof::Items proof_items(std::uint8_t node, const DriveSettings& settings) noexcept {
  ArmingProof::Items items = behaviour_items(settings);
  ObjectWrites pdos;
  bool fits = append_setup(command_pdo(node), pdos) && append_setup(status_pdo(node), pdos) &&
              append_setup(position_pdo(node), pdos);
  for (const ObjectWrite& write : pdos) {
    const bool is_identifier = (write.address.index & kIsMapping) == 0 && write.address.sub == 1;
    const auto demand = is_identifier ? ProofDemand::kIdentifier : ProofDemand::kWritten;
    fits = fits && items.push_back({write, demand, "process data", true});
  }
  assert(fits);
  static_cast<void>(fits);
  return items;
}

ArmingProof::Items whole_proof(std::uint8_t node, const DriveSettings& settings) noexcept {
  ArmingProof::Items items = proof_items(node, settings);
  bool fits = items.push_back({{kVelocity, settings.standstill, 4}, ProofDemand::kAtMost, "stands", true});
  constexpr std::array kIdentity{"vendor", "product code", "revision", "serial number"};
  for (std::uint8_t sub = 1; sub <= kIdentity.size(); ++sub) {
    fits = fits && items.push_back({{{0x1018, sub}, 0, 4}, ProofDemand::kKnown, kIdentity[sub - 1U]});
  }
  assert(fits);
  static_cast<void>(fits);
  return items;
}

// CiA 301: the low 16 bits of 1000h name the device's profile. CiA 402: bit 2 of 6502h is profile velocity.
ArmingProof::Items identity_items() noexcept {
  ArmingProof::Items items;
  static_cast<void>(items.push_back({{{0x1000, 0}, 402, 2}, ProofDemand::kHeld, "device type"}));
  static_cast<void>(items.push_back({{{0x6502, 0}, kHasProfileVelocity, 4}, ProofDemand::kHeld, "modes"}));
  return items;
}

bool speaks_profile_velocity(const ArmingProof::Lines& identity) noexcept {
  const auto was_read = [](const ProofLine& line) {
    return line.verdict == ProofVerdict::kProved || line.verdict == ProofVerdict::kDiffers;
  };
  return identity.size() == 2 && identity[0].verdict == ProofVerdict::kProved && was_read(identity[1]) &&
         (identity[1].said & kHasProfileVelocity) != 0;
}

}  // namespace jaywalk::canopen
