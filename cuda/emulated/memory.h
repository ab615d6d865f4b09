#pragma once
// The memories of an emulated device. Each allocation is poisoned and ends at a page that nothing may touch. Where
// memory is guarded, the host's access to what is not its own is a segmentation fault. (To open and close
// memory takes longer than small kernels do, on virtual machines most of all.)
#include <cstdint>
#include <map>

namespace jaywalk::emulated {

enum class Where : std::uint8_t {
  kDevice,   ///< the device's alone
  kPinned,   ///< of the host; the device's too
  kManaged,  ///< both, the host's while the device has nothing to do (as on a Jetson)
};

/// What the device does, as far as the host knows.
enum class Busy : std::uint8_t {
  kNot,
  kMaybe,  ///< work was queued that the host has not waited for
  kWorks,  ///< it works, and the host waits
};

class Memory {
 public:
  /// Releases all memory. From now on there are `room` bytes; a block that is taken is filled with `poison`.
  void begin_anew(std::size_t room, std::uint8_t poison, bool guarded);
  /// Leaves no room for further blocks.
  void fill() { room_ = 0; }
  /// Null where there is no room.
  [[nodiscard]] void* take(std::size_t bytes, Where where);
  /// `block`: what take() returned, or null.
  void release(void* block);
  void protect(Busy busy);

 private:
  struct Block {
    char* pages;
    std::size_t bytes, used;  ///< asked for; in pages, without the last
    Where where;
  };
  void protect(const Block& block) const;

  std::map<void*, Block> blocks_;
  std::size_t room_ = 0;
  std::uint8_t poison_ = 0;
  bool guarded_ = false;
  Busy busy_ = Busy::kNot;
};

}  // namespace jaywalk::emulated
