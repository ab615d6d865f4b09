#include "tests/drivers/fuzz/fuzz_targets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>

#include "drivers/can/kernel_frame.h"
#include "drivers/canopen/cia402.h"
#include "drivers/canopen/drive_settings.h"
#include "drivers/canopen/sdo_client.h"
#include "drivers/canopen/services.h"
#include "drivers/emulators/drive_objects.h"
#include "drivers/laser/ld_sweep.h"
#include "drivers/laser/scip.h"
#include "drivers/laser/sick_scan.h"
#include "drivers/motor/odrive.h"
#include "drivers/motor/vesc.h"

namespace jaywalk::tests {

namespace {

constexpr Time kArrival{std::chrono::seconds(10)};

void require(bool holds) {
  if (!holds) std::abort();
}

/// A bus that takes everything and says nothing.
class SilentBus final : public CanBus {
 public:
  [[nodiscard]] SendResult send(const CanFrame&) noexcept override { return SendResult::kQueued; }
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

void check_scan(Decoding decoding, const LaserScan& scan) {
  if (decoding != Decoding::kScan) return;
  require(scan.beam_count <= kMaxBeams);
  require(scan.stamp <= kArrival && scan.sweep >= Duration{0} && scan.period >= Duration{0});
  for (std::uint32_t beam = 0; beam < scan.beam_count; ++beam) require(std::isfinite(scan.range_m[beam]));
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
  each_frame(bytes, 0x7FF, [&](const CanFrame& frame) {
    if (const auto emergency = canopen::decode_emergency(frame)) require(emergency_frame(*emergency) == frame);
    if (const auto beat = canopen::decode_heartbeat(frame)) require(beat->node >= 1 && beat->node <= 127);
    static_cast<void>(canopen::unpack(canopen::status_pdo(5).mapping, frame));
    if (const auto answer = objects.answer(5, frame)) require(answer->id == 0x585 && answer->size == 8);
  });
}

void fuzz_sdo_client(wire::Bytes bytes) {
  SilentBus bus;
  canopen::SdoClient client(bus, 5, std::chrono::milliseconds(50));
  const std::array<std::uint8_t, 40> value{};
  Time now = kArrival;
  const bool writes = !bytes.empty() && bytes[0] % 2 == 0;
  require(writes ? client.write({0x1008, 0}, value, now) : client.read({0x1008, 0}, now));
  each_frame(bytes, 0, [&](CanFrame frame) {
    frame.id = 0x585;
    frame.extended = false;
    client.on_frame(frame, now += std::chrono::milliseconds(1));
    require(client.value().size() <= canopen::SdoClient::kMaxBytes);
  });
  client.poll(now + std::chrono::milliseconds(50));
  require(client.status() != canopen::SdoStatus::kBusy);
}

void fuzz_motors(wire::Bytes bytes) {
  each_frame(bytes, 0x1FFF, [](const CanFrame& frame) {
    static_cast<void>(vesc::decode(frame));
    const auto message = odrive::decode(frame);
    if (!message) return;
    const auto* estimates = std::get_if<odrive::EncoderEstimates>(&message->content);
    if (estimates != nullptr) {
      require(std::isfinite(estimates->position_turns) && std::isfinite(estimates->velocity_turns_per_s));
    }
  });
}

/// Filled again and again: what a refused scan leaves in it must not matter.
LaserScan& reused_scan() {
  static LaserScan scan;
  return scan;
}

void fuzz_sick(wire::Bytes bytes) {
  LaserScan& scan = reused_scan();
  for (const sick::Cola dialect : {sick::Cola::kA, sick::Cola::kB}) {
    sick::ColaStream stream(dialect);
    sick::ScanHeader header;
    check_scan(decode_scan(dialect, bytes, {}, kArrival, scan, header), scan);
    stream.append(bytes);
    while (const auto body = stream.next()) check_scan(decode_scan(dialect, *body, {}, kArrival, scan, header), scan);
  }
}

void fuzz_scip(wire::Bytes bytes) {
  LaserScan& scan = reused_scan();
  scip::AnswerStream stream;
  std::uint32_t device_time_ms = 0;
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  check_scan(scip::decode_scan(text, {}, kArrival, scan, device_time_ms), scan);
  stream.append(bytes);
  while (const auto answer = stream.next()) {
    check_scan(scip::decode_scan(*answer, {}, kArrival, scan, device_time_ms), scan);
  }
}

void fuzz_ldrobot(wire::Bytes bytes) {
  LaserScan& scan = reused_scan();
  ldrobot::PacketStream as_it_came, with_right_checksums;
  ldrobot::SweepBuilder builder;
  as_it_came.append(bytes);
  while (const auto packet = as_it_came.next()) {
    if (builder.add(*packet, kArrival, scan)) check_scan(Decoding::kScan, scan);
  }
  // So that what lies behind the checksum is tried as well.
  for (; bytes.size() >= ldrobot::kPacketBytes; bytes = bytes.subspan(ldrobot::kPacketBytes)) {
    std::array<std::uint8_t, ldrobot::kPacketBytes> made{0x54, 0x2C};
    std::copy_n(bytes.begin() + 2, made.size() - 3, made.begin() + 2);
    made.back() = ldrobot::crc8(wire::Bytes(made).first(made.size() - 1));
    with_right_checksums.append(made);
    while (const auto packet = with_right_checksums.next()) {
      if (builder.add(*packet, kArrival, scan)) check_scan(Decoding::kScan, scan);
    }
  }
}

constexpr std::array<FuzzTarget, kFuzzTargets> kTargets{{{"kernel_frame", fuzz_kernel_frame},
                                                         {"canopen", fuzz_canopen},
                                                         {"sdo_client", fuzz_sdo_client},
                                                         {"motors", fuzz_motors},
                                                         {"sick", fuzz_sick},
                                                         {"scip", fuzz_scip},
                                                         {"ldrobot", fuzz_ldrobot}}};

}  // namespace

const FuzzTarget& fuzz_target(std::size_t index) { return kTargets[index]; }

}  // namespace jaywalk::tests
