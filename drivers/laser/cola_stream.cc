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

std::optional<wire::Bytes> ColaStream::next() noexcept {
  queue_.drop(handed_out_);
  handed_out_ = 0;
  return dialect_ == Cola::kA ? next_a() : next_b();
}

std::optional<wire::Bytes> ColaStream::next_a() noexcept {
  for (;;) {
    skip(position(queue_.waiting(), kStx));
    const wire::Bytes waiting = queue_.waiting();
    if (waiting.empty()) return std::nullopt;
    const std::size_t end = position(waiting, kEtx);
    // A second beginning before the end: the first telegram was cut off.
    const std::size_t again = 1 + position(waiting.subspan(1), kStx);
    if (again < end) {
      skip(again);
      continue;
    }
    if (end == waiting.size() && end <= kMaxBody) return std::nullopt;
    if (end > kMaxBody) {
      skip(1);
      continue;
    }
    handed_out_ = end + 1;
    return waiting.subspan(1, end - 1);
  }
}

std::optional<wire::Bytes> ColaStream::next_b() noexcept {
  for (;;) {
    const wire::Bytes all = queue_.waiting();
    const auto found = std::search(all.begin(), all.end(), kBeginningB.begin(), kBeginningB.end());
    if (found == all.end()) {
      skip(all.size() - std::min(all.size(), kBeginningB.size() - 1));  // its last bytes may begin a beginning
      return std::nullopt;
    }
    skip(static_cast<std::size_t>(found - all.begin()));
    const wire::Bytes waiting = queue_.waiting();
    if (waiting.size() < kHeaderB) return std::nullopt;
    const std::size_t length = wire::big_endian<std::uint32_t>(waiting.subspan(4));
    if (length == 0 || length > kMaxBody) {
      skip(1);
      continue;
    }
    if (waiting.size() < kHeaderB + length + 1) return std::nullopt;
    const wire::Bytes body = waiting.subspan(kHeaderB, length);
    if (xor_of(body) != waiting[kHeaderB + length]) {
      skip(1);
      continue;
    }
    handed_out_ = kHeaderB + length + 1;
    return body;
  }
}

void ColaStream::skip(std::size_t count) noexcept {
  queue_.drop(count);
  skipped_ += count;
}

ColaCommand framed(Cola dialect, std::string_view command) noexcept {
  ColaCommand out;
  const std::size_t framing = dialect == Cola::kA ? 2 : kHeaderB + 1;
  if (command.size() + framing > ColaCommand::capacity()) return out;
  const auto push = [&out](std::uint8_t byte) { return out.push_back(byte); };
  bool fits = true;
  if (dialect == Cola::kA) {
    fits = push(kStx);
  } else {
    std::array<std::uint8_t, kHeaderB> header{kStx, kStx, kStx, kStx};
    wire::put_big_endian(static_cast<std::uint32_t>(command.size()), std::span(header).subspan(4));
    for (const std::uint8_t byte : header) fits = fits && push(byte);
  }
  std::uint8_t sum = 0;
  for (const char c : command) {
    fits = fits && push(static_cast<std::uint8_t>(c));
    sum ^= static_cast<std::uint8_t>(c);
  }
  fits = fits && push(dialect == Cola::kA ? kEtx : sum);
  if (!fits) out.clear();
  return out;
}

}  // namespace jaywalk::sick
