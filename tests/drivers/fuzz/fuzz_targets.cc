#include "tests/drivers/fuzz/fuzz_targets.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "drivers/arcos/arcos_base.h"
#include "drivers/can/socketcan.h"
#include "drivers/canopen/cia402.h"
#include "drivers/canopen/drive_base.h"
#include "drivers/canopen/drive_proof.h"
#include "drivers/canopen/sdo_client.h"
#include "drivers/motor/odrive.h"
#include "drivers/motor/vesc.h"
#include "hal/types/errors.h"
#include "hil/emulators/cia402_node.h"
#include "tests/drivers/eds_file.h"

namespace jaywalk::tests {

namespace {

/// A bus that takes everything and says nothing.
class SilentBus final : public CanBus {
 public:
  [[nodiscard]] bool send(const CanFrame&) noexcept override { return true; }
  [[nodiscard]] bool receive(ReceivedFrame&) noexcept override { return false; }
  [[nodiscard]] CanHealth health() const noexcept override { return {}; }
};

/// Bytes as a row of frames: two for identifier and kind, one for the size, eight.
template <class Take>
void each_frame(wire::Bytes bytes, std::uint32_t identifiers, Take take) {
  for (; bytes.size() >= 11; bytes = bytes.subspan(11)) {
    CanFrame frame;
    frame.id = wire::little_endian<std::uint16_t>(bytes) & identifiers;
    frame.extended = (bytes[1] & 0x80U) != 0;
    frame.size = static_cast<std::uint8_t>(bytes[2] % 9);
    std::copy_n(bytes.begin() + 3, frame.size, frame.bytes.begin());
    take(frame);
  }
}

void fuzz_kernel_frame(wire::Bytes bytes) {
  can_frame raw{};
  if (!bytes.empty()) std::memcpy(&raw, bytes.data(), std::min(bytes.size(), sizeof raw));
  const auto frame = from_kernel(raw);
  if (frame) require(is_valid(*frame) && from_kernel(to_kernel(*frame)) == *frame);
  require(name(state_after(raw, CanState::kActive)) != "unknown state");
}

void fuzz_canopen(wire::Bytes bytes) {
  emulators::DriveObjects objects;
  canopen::WheelAxis axis({.node = 5, .per_rad = 100.0}, std::chrono::milliseconds(50));
  each_frame(bytes, 0x7FF, [&](const CanFrame& frame) {
    const auto node = static_cast<std::uint8_t>(frame.id % 0x80U);
    if (canopen::emergency_in(frame, node)) require(frame.id == 0x080U + node && frame.size == 8);
    if (canopen::heartbeat_in(frame, node)) require(frame.id == 0x700U + node && frame.size > 0);
    axis.take({frame, kArrival});
    if (const auto answer = objects.answer(5, frame)) require(answer->id == 0x585 && answer->size == 8);
  });
}

void fuzz_sdo_client(wire::Bytes bytes) {
  SilentBus bus;
  canopen::SdoClient client(bus, 5, std::chrono::milliseconds(50));
  Time now = kArrival;
  const bool writes = !bytes.empty() && bytes[0] % 2 == 0;
  require(writes ? client.write({{0x1008, 0}, 7, 4}, now) : client.read({0x1008, 0}, now));
  each_frame(bytes, 0, [&](CanFrame frame) {
    frame.id = 0x585;
    frame.extended = false;
    client.on_frame(frame, now += std::chrono::milliseconds(1));
    require(client.value().size() <= canopen::SdoClient::kMaxBytes);
  });
  client.poll(now + std::chrono::milliseconds(50));
  require(client.status() != canopen::SdoStatus::kBusy);
}

void check_finite(const vesc::StopSettings& settings) { require(std::isfinite(settings.brake_current_a)); }

/// The bytes as a VESC's settings in pieces of any size, with the right checksum: so that what lies behind is tried.
void read_settings(wire::Bytes bytes) {
  vesc::SettingsReader reader;
  reader.begin();
  bytes = bytes.first(std::min(bytes.size(), vesc::SettingsReader::kMost));
  for (std::size_t at = 0; at < bytes.size();) {
    vesc::Piece piece;
    piece.offset = static_cast<std::uint16_t>(at);
    piece.size = static_cast<std::uint8_t>(std::min<std::size_t>(1 + bytes[at] % 7, bytes.size() - at));
    std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(at), piece.size, piece.bytes.begin());
    reader.take(piece);
    at += piece.size;
  }
  const auto settings =
      reader.finish({.from = 1, .size = static_cast<std::uint16_t>(bytes.size()), .crc = vesc::crc16(bytes)});
  if (settings) check_finite(*settings);
}

void fuzz_motors(wire::Bytes bytes) {
  vesc::SettingsReader reader;
  each_frame(bytes, 0x1FFF, [&reader](const CanFrame& frame) {
    if (const auto from_vesc = vesc::decode(frame)) {
      if (const auto* piece = std::get_if<vesc::Piece>(&from_vesc->content)) reader.take(*piece);
      const auto* end = std::get_if<vesc::PiecesEnd>(&from_vesc->content);
      const auto settings = end != nullptr ? reader.finish(*end) : std::nullopt;
      if (settings) check_finite(*settings);
    }
    const auto message = odrive::decode(frame);
    if (!message) return;
    const auto* estimates = std::get_if<odrive::EncoderEstimates>(&message->content);
    if (estimates != nullptr) {
      require(std::isfinite(estimates->position_turns) && std::isfinite(estimates->velocity_turns_per_s));
    }
  });
  read_settings(bytes);
}

void fuzz_arcos(wire::Bytes bytes) {
  arcos::PacketReader reader;
  for (; !bytes.empty(); bytes = bytes.subspan(std::min<std::size_t>(bytes.size(), 7))) {
    reader.append(bytes.first(std::min<std::size_t>(bytes.size(), 7)));
    for (wire::Bytes body = reader.next(); !body.empty(); body = reader.next()) {
      if (const auto report = arcos::report_in(body)) require(std::fabs(report->speed_mmps[0]) <= 32768.0);
      static_cast<void>(arcos::encoders_in(body));
      if (const auto settings = arcos::settings_in(body)) require(settings->type.back() == 0);
    }
  }
}

/// A file without a name, for a reader that wants a path.
void fuzz_eds_file(wire::Bytes bytes) {
  static const int file = ::memfd_create("eds", MFD_CLOEXEC);
  static const std::string path = "/proc/self/fd/" + std::to_string(file);
  require(::ftruncate(file, 0) == 0);
  require(::pwrite(file, bytes.data(), bytes.size(), 0) == static_cast<ssize_t>(bytes.size()));
  try {
    const canopen::EdsFile eds(path);
    static_cast<void>(canopen::shortcomings(eds));
  } catch (const StartupError&) {
    return;  // refused, with its reason
  }
}

constexpr std::array<FuzzTarget, kFuzzTargets> kTargets{{{"kernel_frame", fuzz_kernel_frame},
                                                         {"canopen", fuzz_canopen},
                                                         {"sdo_client", fuzz_sdo_client},
                                                         {"eds_file", fuzz_eds_file},
                                                         {"motors", fuzz_motors},
                                                         {"arcos", fuzz_arcos},
                                                         {"sick", fuzz_sick},
                                                         {"scip", fuzz_scip},
                                                         {"ldrobot", fuzz_ldrobot},
                                                         {"lms200", fuzz_lms200},
                                                         {"ros", fuzz_ros},
                                                         {"scanner_protocol", fuzz_scanner_protocol}}};

}  // namespace

const FuzzTarget& fuzz_target(std::size_t index) { return kTargets[index]; }

}  // namespace jaywalk::tests
