#pragma once
// Reads and writes packed little-endian records of numbers and texts.
#include <cstdint>
#include <cstring>
#include <string_view>

namespace jaywalk::exchange {

/// Takes values from the front of bytes; where they end it gives zeros, and `ok` turns false for good.
class LittleEndian {
 public:
  explicit LittleEndian(std::string_view bytes) : bytes_(bytes) {}

  template <class T>
  [[nodiscard]] T number() {
    T value{};
    const std::string_view raw = take(sizeof(T));
    if (raw.size() == sizeof(T)) std::memcpy(&value, raw.data(), sizeof value);  // all our machines are little-endian
    return value;
  }
  [[nodiscard]] std::uint16_t u16() { return number<std::uint16_t>(); }
  [[nodiscard]] std::uint32_t u32() { return number<std::uint32_t>(); }
  [[nodiscard]] std::uint64_t u64() { return number<std::uint64_t>(); }
  /// Behind the number of its bytes.
  [[nodiscard]] std::string_view sized() { return take(u32()); }
  [[nodiscard]] std::string_view take(std::uint64_t bytes) {
    ok_ = ok_ && bytes <= bytes_.size();
    if (!ok_) return {};
    const std::string_view taken = bytes_.substr(0, bytes);
    bytes_.remove_prefix(bytes);
    return taken;
  }
  [[nodiscard]] std::string_view rest() { return take(bytes_.size()); }
  [[nodiscard]] bool empty() const { return bytes_.empty(); }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  std::string_view bytes_;
  bool ok_ = true;
};

}  // namespace jaywalk::exchange
