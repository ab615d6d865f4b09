#pragma once
// The fields of a message, one after the other, as ROS 2 (CDR) and ROS 1 write them, which WireReader reads.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <string_view>

namespace jaywalk::exchange {

enum class Wire {
  kCdr,   ///< OMG's CDR (XCDR1) behind its encapsulation header: numbers at multiples of their size, either byte order
  kRos1,  ///< little endian, packed
  kProtobuf,  ///< foxglove_input.h reads it
  kOther      ///< nothing here reads it
};

/// Reads from bytes that the caller keeps. Behind the end, and in what is no CDR, it gives zeros and `ok` turns false
/// for good.
class WireReader {
 public:
  WireReader(std::string_view bytes, Wire wire) : bytes_(bytes), aligned_(wire == Wire::kCdr) {
    if (!aligned_) return;
    ok_ = bytes_.size() >= kHead && bytes_[0] == 0 && (bytes_[1] == 0 || bytes_[1] == 1);
    swapped_ = ok_ && bytes_[1] == 0;
    bytes_.remove_prefix(std::min(kHead, bytes_.size()));
  }

  template <class T>
  [[nodiscard]] T number() {
    if (aligned_) skip((sizeof(T) - used_ % sizeof(T)) % sizeof(T));
    std::array<char, sizeof(T)> raw{};
    if (take(sizeof(T))) std::memcpy(raw.data(), bytes_.data() + used_ - sizeof(T), sizeof(T));
    if (swapped_) std::reverse(raw.begin(), raw.end());
    T value{};
    std::memcpy(&value, raw.data(), sizeof value);  // all our machines are little-endian
    return value;
  }
  [[nodiscard]] double f64() { return number<double>(); }
  [[nodiscard]] float f32() { return number<float>(); }
  [[nodiscard]] std::uint32_t u32() { return number<std::uint32_t>(); }
  [[nodiscard]] std::string_view text() {
    std::uint32_t size = u32();
    if (!take(size)) return {};
    const std::string_view all = bytes_.substr(used_ - size, size);
    return aligned_ && !all.empty() ? all.substr(0, size - 1) : all;  // CDR ends it with a zero
  }
  /// How many elements follow, each of `bytes` at least: never more than the message can hold.
  [[nodiscard]] std::size_t count(std::size_t bytes) {
    const std::size_t many = u32();
    if (many > (bytes_.size() - used_) / bytes) ok_ = false;
    return ok_ ? many : 0;
  }
  void skip(std::size_t bytes) { (void)take(bytes); }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  bool take(std::size_t bytes) {
    ok_ = ok_ && bytes <= bytes_.size() - used_;
    if (ok_) used_ += bytes;
    return ok_;
  }

  static constexpr std::size_t kHead = 4;
  std::string_view bytes_;
  std::size_t used_ = 0;
  bool aligned_, swapped_ = false, ok_ = true;
};

}  // namespace jaywalk::exchange
