#pragma once
// The memories of an emulated device. Each allocation is poisoned and ends at a page that nothing may touch. What the
// host must not read or write it cannot where memory is guarded: that is a segmentation fault. (To open and close
// memory takes longer than small kernels do, on virtual machines most of all.)
#include <cstddef>
#include <cstdint>
#include <map>

namespace jaywalk::emulated {

enum class Where : std::uint8_t {
  kDevice,   ///< kernels alone
  kPinned,   ///< of the host; kernels too
  kManaged,  ///< both, the host while no kernel is under way (as on a Jetson)
};

class Memory {
 public:
  Memory() = default;
  ~Memory();
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;

  /// Null where there is no room. `most`: bytes that all together may have.
  void* take(std::size_t bytes, Where where, std::size_t most);
  /// False: nothing was taken there.
  bool release(void* block);
  /// All of it. What is taken from now on is guarded, or not.
  void begin_anew(bool guarded);

  /// While a kernel runs, all may be touched.
  void begin_work();
  void end_work();
  /// For a copy: whether the block that holds this address may be touched besides, if there is one.
  void open(const void* in_block, bool open);
  /// Whether kernels are under way, as the host has to take it: from a launch to a wait.
  void set_busy(bool busy);
  [[nodiscard]] std::size_t taken() const { return taken_; }

 private:
  struct Block {
    char* pages;
    std::size_t bytes, used, size;  ///< asked for; in whole pages; with the guarding page
    Where where;
  };
  [[nodiscard]] bool is_open(const Block& block) const;
  static void protect(const Block& block, bool open);
  void protect_all();

  std::map<void*, Block> blocks_;
  std::multimap<std::size_t, char*> spare_;  ///< pages that were released, open, by their size
  std::size_t taken_ = 0;
  bool guarded_ = false;
  bool works_ = false, busy_ = false;
};

}  // namespace jaywalk::emulated
