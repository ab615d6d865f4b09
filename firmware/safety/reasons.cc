#include "firmware/safety/reasons.h"

namespace jaywalk {
Reason reason_named(std::string_view name) noexcept {
  Reason named = Reason::kNone;
  for (const ReasonRow& row : kReasons)
    if (row.name == name) named = row.reason;
  return named;
}

std::string to_string(Reason reasons) {
  std::string words;
  for (const ReasonRow& row : kReasons)
    if (has(reasons, row.reason)) words += (words.empty() ? "" : "|") + std::string(row.name);
  return words;
}

std::string to_string(Reason reasons, std::uint8_t faulty_scanners) {
  std::string words = to_string(reasons);
  for (int number = 1, left = faulty_scanners; left != 0; ++number, left >>= 1) {
    if ((left & 1) != 0) words += (words.empty() ? "scanner_" : "|scanner_") + std::to_string(number);
  }
  return words;
}

}  // namespace jaywalk
