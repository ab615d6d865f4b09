#pragma once
#include <array>
#include <atomic>
#include <cstdint>

namespace jaywalk {

/// Hands the newest T from one writing thread to one reading thread; neither ever waits. Publishing swaps the writer's
/// slot with the middle one, reading swaps the middle with the reader's; what was not read in time is overwritten.
template <class T>
class Mailbox {
 public:
  /// Writer's thread: the slot to fill in place.
  T& draft() noexcept { return slots_[writing_]; }
  /// Writer's thread: what stands in draft() becomes the newest.
  void publish() noexcept { writing_ = middle_.exchange(writing_ | kFresh, std::memory_order_acq_rel) & kSlot; }
  void publish(const T& value) noexcept {
    draft() = value;
    publish();
  }
  /// Reader's thread: the newest published, T{} before the first. Valid until the next call.
  const T& latest() noexcept {
    if (middle_.load(std::memory_order_relaxed) & kFresh)
      reading_ = middle_.exchange(reading_, std::memory_order_acq_rel) & kSlot;
    return slots_[reading_];
  }

 private:
  static constexpr std::uint32_t kSlot = 3, kFresh = 4;
  std::array<T, 3> slots_{};
  std::uint32_t writing_ = 0;
  std::atomic<std::uint32_t> middle_{1};
  std::uint32_t reading_ = 2;
};

}  // namespace jaywalk
