#pragma once
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "hal/types/time.h"

namespace jaywalk::ros {

/// Messages of one fixed size, one way between two processes of one user, in a file that both have mapped.
///
/// One thread writes and one reads; neither waits for the other, and either may die and come back. The writer
/// overwrites the oldest; each slot says which message it holds, so that the reader sees what was overwritten, torn or
/// damaged and goes on at the newest. It believes nothing else that stands in the file. Memory is taken at start.
class SharedRing {
 public:
  struct Shape {
    std::size_t message_bytes = 0;  ///< a multiple of 8
    std::size_t slots = 0;
  };
  enum class Took : std::uint8_t { kNothing, kMessage, kTorn };

  /// Start-up only: a new file of this user's alone, which goes when this does; one that an earlier process left is
  /// replaced. Throws StartupError where it cannot be made, or something else lies there.
  [[nodiscard]] static std::unique_ptr<SharedRing> make(const std::filesystem::path& path, const Shape& shape);
  /// The file that another process of this user made; none while there is no such file. Begins at what comes next.
  [[nodiscard]] static std::unique_ptr<SharedRing> find(const std::filesystem::path& path, const Shape& shape);
  ~SharedRing();
  SharedRing(const SharedRing&) = delete;
  SharedRing& operator=(const SharedRing&) = delete;

  /// Whether the path still leads to this file.
  [[nodiscard]] bool is_current() const noexcept;

  /// Writer's thread. `message` has the shape's size.
  void write(std::span<const std::byte> message) noexcept;
  /// Reader's thread: the oldest that was not read, into `message` of the shape's size, which is spoilt where it is
  /// torn.
  [[nodiscard]] Took read(std::span<std::byte> message) noexcept;
  /// Reader's thread: forgets what waits.
  void skip() noexcept;
  /// Reader's thread: returns when a message waits, at an alarm, or after `most`.
  void wait(Duration most) const noexcept;
  /// How many messages were overwritten before they were read.
  [[nodiscard]] std::uint64_t lost() const noexcept { return lost_; }

  /// Beside the messages, from any thread of the writer's process: something that is not to wait for its turn.
  void raise_alarm() noexcept;
  [[nodiscard]] std::uint64_t alarms() const noexcept;

 private:
  struct Header;
  struct Mapping;

  SharedRing(std::unique_ptr<Mapping> mapping, const Shape& shape) noexcept;
  [[nodiscard]] Header& header() const noexcept;
  /// The slot's own number, followed by the message.
  [[nodiscard]] std::uint64_t* slot_of(std::uint64_t number) const noexcept;
  void ring_bell() noexcept;

  std::unique_ptr<Mapping> mapping_;
  Shape shape_;
  std::uint64_t written_, next_;  ///< the last one written; the next one to read. From 1
  std::uint64_t lost_ = 0;
};

}  // namespace jaywalk::ros
