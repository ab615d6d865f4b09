#include <algorithm>
#include <array>

#include "drivers/laser/sick.h"

namespace jaywalk::sick {
namespace {

constexpr std::uint8_t kStx = 0x02, kEtx = 0x03;
constexpr std::array<std::uint8_t, 4> kBeginningB{kStx, kStx, kStx, kStx};
constexpr std::size_t kHeaderB = 8;

std::uint8_t xor_of(wire::Bytes bytes) noexcept {
  std::uint8_t sum = 0;
  for (const std::uint8_t byte : bytes) sum ^= byte;
  return sum;
}

std::size_t position(wire::Bytes bytes, std::uint8_t wanted) noexcept {
  return static_cast<std::size_t>(std::find(bytes.begin(), bytes.end(), wanted) - bytes.begin());
}

}  // namespace

std::optional<wire::Bytes> ColaStream::next_a() noexcept {
  for (;;) {
    skip(position(waiting(), kStx));
    const wire::Bytes rest = waiting();
    if (rest.empty()) return std::nullopt;
    const std::size_t end = position(rest, kEtx);
    // A second beginning before the end: the first telegram was cut off.
    const std::size_t again = 1 + position(rest.subspan(1), kStx);
    if (again < end) {
      skip(again);
      continue;
    }
    if (end == rest.size() && end <= kMaxBody) return std::nullopt;
    if (end > kMaxBody) {
      skip(1);
      continue;
    }
    drop(end + 1);
    return rest.subspan(1, end - 1);
  }
}

std::optional<wire::Bytes> ColaStream::next_b() noexcept {
  for (;;) {
    const wire::Bytes all = waiting();
    const auto found = std::search(all.begin(), all.end(), kBeginningB.begin(), kBeginningB.end());
    if (found == all.end()) {
      skip(all.size() - std::min(all.size(), kBeginningB.size() - 1));  // its last bytes may begin a beginning
      return std::nullopt;
    }
    skip(static_cast<std::size_t>(found - all.begin()));
    const wire::Bytes rest = waiting();
    if (rest.size() < kHeaderB) return std::nullopt;
    const std::size_t length = wire::big_endian<std::uint32_t>(rest.subspan(4));
    if (length == 0 || length > kMaxBody) {
      skip(1);
      continue;
    }
    if (rest.size() < kHeaderB + length + 1) return std::nullopt;
    const wire::Bytes body = rest.subspan(kHeaderB, length);
    if (xor_of(body) != rest[kHeaderB + length]) {
      skip(1);
      continue;
    }
    drop(kHeaderB + length + 1);
    return body;
  }
}

ColaCommand framed(Cola dialect, std::string_view command) noexcept {
  const bool is_text = dialect == Cola::kA;
  const wire::Bytes body(reinterpret_cast<const std::uint8_t*>(command.data()), command.size());
  std::array<std::uint8_t, kHeaderB> header{kStx, kStx, kStx, kStx};
  wire::put_big_endian(static_cast<std::uint32_t>(body.size()), std::span(header).subspan(4));
  ColaCommand out;
  bool fits = true;
  const auto push = [&](std::uint8_t byte) { fits = fits && out.push_back(byte); };
  for (const std::uint8_t byte : wire::Bytes(header).first(is_text ? 1 : kHeaderB)) push(byte);
  for (const std::uint8_t byte : body) push(byte);
  push(is_text ? kEtx : xor_of(body));
  if (!fits) out.clear();
  return out;
}

}  // namespace jaywalk::sick
