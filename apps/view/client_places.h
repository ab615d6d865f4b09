#pragma once
// How many clients there may be at a time, and which of them goes for a newcomer.
#include <chrono>
#include <cstdint>
#include <optional>
#include <span>

namespace jaywalk::view {

/// How far a client has come.
enum class Stage : std::uint8_t {
  kAsks,        ///< its request is not whole yet
  kEncrypts,    ///< nor that, by TLS: it costs a hundred times the memory
  kIsAnswered,  ///< a page, a stop or a refusal is on its way to it
  kLooks,       ///< it has a WebSocket
  kGone
};

/// Places of a stage; this machine's clients and those of others have as many each, so that neither take the other's.
[[nodiscard]] constexpr std::size_t places(Stage stage) noexcept {
  constexpr std::size_t kPlaces[] = {128, 64, 16, 8, 0};
  return kPlaces[static_cast<std::size_t>(stage)];
}

/// A client in its place.
struct Placed {
  using Clock = std::chrono::steady_clock;
  std::uint32_t address = 0;
  Clock::time_point since{};
  Clock::duration stuck{};  ///< for how long it has taken nothing of what is sent to it
  bool is_served = false;   ///< its answer is whole in the kernel's hands
};

/// Which of `placed` gives way to one more of `address` where all places are taken. Before it looks: one that is
/// served, else the oldest of the address that has most places, so that many requests from one address turn away each
/// other. Looking: the one stuck longest, from a second on; else the oldest of an address that has at least two more
/// than the newcomer's; else none does.
[[nodiscard]] std::optional<std::size_t> gives_way(std::span<const Placed> placed, Stage stage, std::uint32_t address);

}  // namespace jaywalk::view
