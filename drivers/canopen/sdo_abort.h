#pragma once
#include <cstdint>
#include <string_view>

namespace jaywalk::canopen {

/// Why a transfer of an object was given up (CiA 301, SDO abort codes): those that this client sends itself.
inline constexpr std::uint32_t kAbortToggle = 0x05030000, kAbortTimeout = 0x05040000, kAbortUnknownCommand = 0x05040001,
                               kAbortNoMemory = 0x05040005, kAbortLength = 0x06070010;
/// What a drive says of an object that it keeps as it is.
inline constexpr std::uint32_t kAbortReadOnly = 0x06010002;

/// In words; "unknown reason" for a code that the standard does not list.
[[nodiscard]] std::string_view abort_name(std::uint32_t code) noexcept;

}  // namespace jaywalk::canopen
