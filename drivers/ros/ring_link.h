#pragma once
#include "drivers/ros/ring_messages.h"
#include "drivers/wire/byte_link.h"

namespace jaywalk::ros {

/// The scans that jaywalk_dds puts into a shared ring, as a link that brings one whole message at a time; a torn one is
/// a single byte. It is open at once: scans that do not come are a silent scanner.
class RingLink final : public wire::Link {
 public:
  /// Makes the ring. `name`: the topic. Throws StartupError.
  RingLink(const std::filesystem::path& ring, std::string name)
      : ring_(SharedRing::make(ring, kScanRing)), name_(std::move(name)) {}

  [[nodiscard]] const std::string& name() const noexcept override { return name_; }
  void open() noexcept override;
  void close() noexcept override { state_ = State::kClosed; }
  [[nodiscard]] State state() noexcept override { return state_; }
  [[nodiscard]] wire::Bytes read(std::span<std::uint8_t> room) noexcept override;
  void write(wire::Bytes) noexcept override {}
  void wait(Duration most) noexcept override;

 private:
  std::unique_ptr<SharedRing> ring_;
  std::string name_;
  State state_ = State::kClosed;
  std::array<std::uint8_t, kScanRing.message_bytes> message_{};
};

}  // namespace jaywalk::ros
