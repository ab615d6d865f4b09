#include "drivers/canopen/sdo_client.h"

#include <algorithm>

namespace jaywalk::canopen {
namespace {

constexpr std::uint32_t kRequestBase = 0x600, kAnswerBase = 0x580;
constexpr std::size_t kExpedited = 4, kSegment = 7;
constexpr std::size_t kAddressed = 4;  ///< bytes of command and address; what follows of an answer may be cut off

// The command byte: a specifier in bits 7 to 5, and beside it what the transfer's step needs (CiA 301).
constexpr std::uint8_t kAbort = 0x80, kReadRequest = 0x40, kReadSegmentRequest = 0x60, kWriteRequest = 0x20;
constexpr std::uint8_t kExpeditedBit = 0x02, kSizeBit = 0x01, kToggleBit = 0x10, kLastBit = 0x01;
constexpr std::uint8_t kReadAnswer = 2, kWriteAnswer = 3, kReadSegmentAnswer = 0;

constexpr std::uint8_t specifier(const CanFrame& frame) { return static_cast<std::uint8_t>(frame.bytes[0] >> 5U); }
constexpr bool has(const CanFrame& frame, std::uint8_t bit) { return (frame.bytes[0] & bit) != 0; }

struct Reason {
  std::uint32_t code;
  std::string_view name;
};

constexpr std::array kReasons{
    Reason{0x05030000, "toggle bit did not alternate"},
    Reason{0x05040000, "no answer in time"},
    Reason{0x05040001, "unknown command"},
    Reason{0x05040002, "bad block size"},
    Reason{0x05040003, "bad sequence number"},
    Reason{0x05040004, "checksum error"},
    Reason{0x05040005, "out of memory"},
    Reason{0x06010000, "access not supported"},
    Reason{0x06010001, "write only"},
    Reason{0x06010002, "read only"},
    Reason{0x06020000, "no such object"},
    Reason{0x06040041, "cannot be mapped to a PDO"},
    Reason{0x06040042, "mapping longer than a PDO"},
    Reason{0x06040043, "incompatible parameters"},
    Reason{0x06040047, "incompatible inside the device"},
    Reason{0x06060000, "hardware error"},
    Reason{0x06070010, "length does not match"},
    Reason{0x06070012, "too long"},
    Reason{0x06070013, "too short"},
    Reason{0x06090011, "no such sub-index"},
    Reason{0x06090030, "value out of range"},
    Reason{0x06090031, "value too high"},
    Reason{0x06090032, "value too low"},
    Reason{0x06090036, "maximum below minimum"},
    Reason{0x060A0023, "resource not available"},
    Reason{0x08000000, "general error"},
    Reason{0x08000020, "cannot be stored"},
    Reason{0x08000021, "refused: under local control"},
    Reason{0x08000022, "refused in the device's present state"},
    Reason{0x08000023, "no object dictionary"},
    Reason{0x08000024, "no value there"},
};

}  // namespace

bool SdoClient::read(ObjectAddress address, Time now) noexcept {
  if (status_ == SdoStatus::kBusy) return false;
  start(Phase::kReadStart, address, now);
  send_addressed(kReadRequest, 0);
  return true;
}

bool SdoClient::write(const ObjectWrite& object, Time now) noexcept {
  if (status_ == SdoStatus::kBusy) return false;
  start(Phase::kWrite, object.address, now);
  const auto unused = static_cast<std::uint8_t>((kExpedited - object.bytes) << 2U);
  send_addressed(kWriteRequest | kExpeditedBit | kSizeBit | unused, cut(object.value, object.bytes));
  return true;
}

void SdoClient::start(Phase phase, ObjectAddress address, Time now) noexcept {
  phase_ = phase;
  status_ = SdoStatus::kBusy;
  address_ = address;
  heard_ = now;
  abort_code_ = 0;
  toggle_ = false;
  announced_size_.reset();
  size_ = 0;
}

void SdoClient::poll(Time now) noexcept {
  if (status_ == SdoStatus::kBusy && now - heard_ >= timeout_) abort_here(kAbortTimeout);
}

void SdoClient::on_frame(const CanFrame& frame, Time now) noexcept {
  if (status_ != SdoStatus::kBusy || frame.extended || frame.remote || frame.id != kAnswerBase + node_) return;
  // What names another object belongs to a transfer that was given up before this one began.
  const bool is_abort = frame.bytes[0] == kAbort;
  const bool names_object = is_abort || phase_ != Phase::kReadSegments;
  if (frame.size < (names_object ? kAddressed : 1)) return abort_here(kAbortLength);
  const ObjectAddress named{wire::little_endian<std::uint16_t>(wire::Bytes(frame.bytes).subspan(1)), frame.bytes[3]};
  if (names_object && named != address_) return;
  heard_ = now;
  if (is_abort)
    return finish(SdoStatus::kAbortedByDrive, wire::little_endian<std::uint32_t>(std::span(frame.bytes).subspan(4)));
  switch (phase_) {
    case Phase::kReadStart: return on_read_start(frame);
    case Phase::kReadSegments: return on_read_segment(frame);
    case Phase::kWrite:
      return specifier(frame) == kWriteAnswer ? finish(SdoStatus::kDone) : abort_here(kAbortUnknownCommand);
    case Phase::kNone: return;
  }
}

void SdoClient::on_read_start(const CanFrame& frame) noexcept {
  if (specifier(frame) != kReadAnswer) return abort_here(kAbortUnknownCommand);
  const wire::Bytes body = wire::Bytes(frame.bytes).subspan(kAddressed);
  const std::size_t came = frame.size - kAddressed;
  if (has(frame, kExpeditedBit)) {
    const std::size_t used = has(frame, kSizeBit) ? kExpedited - ((frame.bytes[0] >> 2U) & 3U) : came;
    if (used > came || used == 0) return abort_here(kAbortLength);
    if (append(body.first(used))) finish(SdoStatus::kDone);
    return;
  }
  if (has(frame, kSizeBit)) announced_size_ = wire::little_endian<std::uint32_t>(body);
  if (announced_size_ > kMaxBytes) return abort_here(kAbortNoMemory);
  phase_ = Phase::kReadSegments;
  ask_segment();
}

void SdoClient::ask_segment() noexcept {
  send({static_cast<std::uint8_t>(kReadSegmentRequest | (toggle_ ? kToggleBit : 0))});
}

void SdoClient::on_read_segment(const CanFrame& frame) noexcept {
  if (specifier(frame) != kReadSegmentAnswer) return abort_here(kAbortUnknownCommand);
  if (has(frame, kToggleBit) != toggle_) return abort_here(kAbortToggle);
  const std::size_t used = kSegment - ((frame.bytes[0] >> 1U) & 7U);
  if (used + 1 > frame.size) return abort_here(kAbortLength);
  if (!append(frame.payload().subspan(1, used))) return;
  toggle_ = !toggle_;
  if (!has(frame, kLastBit)) return ask_segment();
  if (announced_size_ && size_ != announced_size_) return abort_here(kAbortLength);
  finish(SdoStatus::kDone);
}

bool SdoClient::append(wire::Bytes bytes) noexcept {
  if (bytes.size() > kMaxBytes - size_) {
    abort_here(kAbortNoMemory);
    return false;
  }
  std::copy(bytes.begin(), bytes.end(), buffer_.begin() + static_cast<std::ptrdiff_t>(size_));
  size_ += bytes.size();
  return true;
}

void SdoClient::send_addressed(std::uint8_t command, std::uint32_t word) noexcept {
  std::array<std::uint8_t, 8> bytes{command};
  wire::put_little_endian(address_.index, std::span(bytes).subspan(1));
  bytes[3] = address_.sub;
  wire::put_little_endian(word, std::span(bytes).subspan(4));
  send(bytes);
}

void SdoClient::send(const std::array<std::uint8_t, 8>& bytes) noexcept {
  if (!bus_.send({.id = kRequestBase + node_, .size = 8, .bytes = bytes})) finish(SdoStatus::kNotSent);
}

void SdoClient::abort_here(std::uint32_t code) noexcept {
  send_addressed(kAbort, code);
  finish(SdoStatus::kAbortedHere, code);
}

void SdoClient::finish(SdoStatus status, std::uint32_t code) noexcept {
  status_ = status;
  phase_ = Phase::kNone;
  abort_code_ = code;
}

std::string_view abort_name(std::uint32_t code) noexcept {
  const auto* found =
      std::find_if(kReasons.begin(), kReasons.end(), [code](const Reason& r) { return r.code == code; });
  return found == kReasons.end() ? "unknown reason" : found->name;
}

}  // namespace jaywalk::canopen
