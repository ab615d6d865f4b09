#include "drivers/canopen/foreign_frames.h"

#include <cassert>

namespace jaywalk::canopen {
namespace {

constexpr std::uint32_t kNmt = 0x000, kSync = 0x080, kLss = 0x7E5, kHeartbeat = 0x700, kSdoRequest = 0x600,
                        kSdoAnswer = 0x580;
constexpr std::array<std::uint32_t, 4> kReceivePdos{0x200, 0x300, 0x400, 0x500};

std::string kind_of(std::uint32_t id) {
  if (id == kNmt) return "NMT command";
  if (id == kSync) return "SYNC";
  if (id == kLss) return "LSS command";
  const std::string node = " node " + std::to_string(id & 0x7FU);
  const std::uint32_t base = id & ~0x7FU;
  if (base == kHeartbeat) return "heartbeat of" + node;
  if (base == kSdoRequest) return "SDO request to" + node;
  if (base == kSdoAnswer) return "SDO answer that was not asked for, of" + node;
  const bool from_drive = base == 0x180 || base == 0x280;  // of which two are too many
  return (from_drive ? "process data, too often, of" : "process data to") + node;
}

}  // namespace

Identifiers masters_identifiers(std::uint8_t controller_node, const std::array<std::uint8_t, 2>& drives) noexcept {
  Identifiers ids;
  bool fit =
      ids.push_back(kNmt) && ids.push_back(kSync) && ids.push_back(kLss) && ids.push_back(kHeartbeat + controller_node);
  for (const std::uint8_t node : drives) {
    for (const std::uint32_t base : kReceivePdos) fit = fit && ids.push_back(base + node);
    fit = fit && ids.push_back(kSdoRequest + node);
  }
  assert(fit);
  static_cast<void>(fit);
  return ids;
}

std::string describe_foreign(const CanFrame& frame) { return kind_of(frame.id) + " (" + to_text(frame) + ")"; }

}  // namespace jaywalk::canopen
