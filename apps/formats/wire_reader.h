#pragma once
// Fields of a message or record, one after the other: ROS 2 (CDR), ROS 1, MCAP.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <string>
#include <string_view>

namespace jaywalk::exchange {

enum class Wire {
  kCdr,   ///< OMG's CDR (XCDR1) behind its encapsulation header: numbers at multiples of their size, either byte order
  kRos1,  ///< little endian, packed; so are the records of bags and MCAP files
  kProtobuf,  ///< ros_input.h reads it
  kOther      ///< nothing here reads it
};

/// Reads from the front of bytes that the caller keeps. Behind the end, and in what is no CDR, it gives zeros and `ok`
/// turns false for good.
class WireReader {
 public:
  explicit WireReader(std::string_view bytes, Wire wire = Wire::kRos1) : bytes_(bytes), aligned_(wire == Wire::kCdr) {
    if (!aligned_) return;
    ok_ = bytes_.size() >= kHead && bytes_[0] == 0 && (bytes_[1] == 0 || bytes_[1] == 1);
    swapped_ = ok_ && bytes_[1] == 0;
    bytes_.remove_prefix(std::min(kHead, bytes_.size()));
  }

  template <class T>
  [[nodiscard]] T number() {
    if (aligned_) skip((sizeof(T) - used_ % sizeof(T)) % sizeof(T));
    std::array<char, sizeof(T)> raw{};
    std::ranges::copy(take(sizeof(T)), raw.begin());
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  [[nodiscard]] double f64() { return number<double>(); }
  [[nodiscard]] float f32() { return number<float>(); }
  [[nodiscard]] std::uint16_t u16() { return number<std::uint16_t>(); }
  [[nodiscard]] std::uint32_t u32() { return number<std::uint32_t>(); }
  [[nodiscard]] std::uint64_t u64() { return number<std::uint64_t>(); }
  [[nodiscard]] std::string_view take(std::uint64_t bytes) {
    ok_ = ok_ && bytes <= bytes_.size() - used_;
    if (!ok_) return {};
    used_ += bytes;
    return bytes_.substr(used_ - bytes, bytes);
  }
  void skip(std::size_t bytes) { (void)take(bytes); }
  /// Behind the number of its bytes.
  [[nodiscard]] std::string_view sized() { return take(u32()); }
  [[nodiscard]] std::string_view text() {
    const std::string_view all = sized();
    return aligned_ && !all.empty() ? all.substr(0, all.size() - 1) : all;  // CDR ends it with a zero
  }
  [[nodiscard]] std::string_view rest() { return take(bytes_.size() - used_); }
  /// How many elements follow, each of `bytes` at least: never more than the message can hold.
  [[nodiscard]] std::size_t count(std::size_t bytes) {
    const std::size_t many = u32();
    if (many > (bytes_.size() - used_) / bytes) ok_ = false;
    return ok_ ? many : 0;
  }
  [[nodiscard]] bool empty() const { return used_ == bytes_.size(); }
  [[nodiscard]] bool ok() const { return ok_; }

 private:
  static constexpr std::size_t kHead = 4;
  std::string_view bytes_;
  std::size_t used_ = 0;
  bool aligned_, swapped_ = false, ok_ = true;
};

/// The bytes of a number; all our machines are little-endian.
template <class T>
[[nodiscard]] std::string raw(T value) {
  const auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(value);
  return {bytes.data(), bytes.size()};
}

/// Writes OMG's CDR (XCDR1, little endian), as ROS 2's messages are. Numbers stand at multiples of their size, counted
/// from behind the encapsulation's four bytes.
class CdrWriter {
 public:
  template <class T>
  CdrWriter& number(T value) {
    bytes_.resize(kHead + (bytes_.size() - kHead + sizeof(T) - 1) / sizeof(T) * sizeof(T));
    bytes_ += raw(value);
    return *this;
  }
  CdrWriter& f64(double value) { return number(value); }
  CdrWriter& f32(double value) { return number(static_cast<float>(value)); }
  CdrWriter& u32(std::size_t value) { return number(static_cast<std::uint32_t>(value)); }
  CdrWriter& i32(std::int64_t value) { return number(static_cast<std::int32_t>(value)); }
  CdrWriter& u8(unsigned value) { return number(static_cast<std::uint8_t>(value)); }
  CdrWriter& text(std::string_view text) {
    u32(text.size() + 1);
    bytes_.append(text).push_back('\0');
    return *this;
  }
  /// Bytes behind their count.
  CdrWriter& bytes(std::string_view raw) {
    u32(raw.size());
    bytes_.append(raw);
    return *this;
  }
  [[nodiscard]] const std::string& message() const { return bytes_; }

 private:
  static constexpr std::size_t kHead = 4;
  std::string bytes_{"\0\1\0\0", kHead};
};

}  // namespace jaywalk::exchange
