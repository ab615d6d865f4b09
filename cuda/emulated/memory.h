#pragma once
// The memories of an emulated device. Each allocation is poisoned and ends at a page that nothing may touch. What the
// host must not read or write it cannot where memory is guarded: that is a segmentation fault. (To open and close
// memory takes longer than small kernels do, on virtual machines most of all.)
#include <cstdint>
#include <map>

namespace jaywalk::emulated {

enum class Where : std::uint8_t {
  kDevice,   ///< the device's alone
  kPinned,   ///< of the host; the device's too
  kManaged,  ///< both, the host's while the device has nothing to do (as on a Jetson)
};

/// The device, as the host has to take it.
enum class Busy : std::uint8_t {
  kNot,
  kMaybe,  ///< it has something to do that has not been waited for
  kWorks,  ///< it does it now, while the host waits
};

class Memory {
 public:
  /// Releases all, and has room for so many bytes from now on. What nothing has been written to is `poison`.
  void begin_anew(std::size_t room, std::uint8_t poison, bool guarded);
  /// From now on there is no room for more.
  void fill() { room_ = 0; }
  /// Null where there is no room.
  [[nodiscard]] void* take(std::size_t bytes, Where where);
  /// Null or what was taken.
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
