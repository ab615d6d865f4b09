#pragma once
// The memories of an emulated device. Each allocation is poisoned and ends at a page that nothing may touch. Where
// memory is guarded, the host's access to what is not its own is a segmentation fault. (To open and close
// memory takes longer than small kernels do, on virtual machines most of all.)
#include <cstdint>
#include <map>

namespace jaywalk::emulated {

enum class Where : std::uint8_t {
  kDevice,  ///< the device's alone
  kPinned,  ///< of the host; the device's too
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
  /// `works`: the device does, and the host waits.
  void protect(bool works);

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
  bool works_ = false;
};

}  // namespace jaywalk::emulated
