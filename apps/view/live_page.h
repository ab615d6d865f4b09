#pragma once
#include <string_view>

namespace jaywalk::view {

/// The page of page/, built into the program by embed.cmake.
[[nodiscard]] std::string_view live_page() noexcept;

}  // namespace jaywalk::view
