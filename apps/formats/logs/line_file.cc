#include <algorithm>
#include <cmath>

#include "apps/formats/logs/log_checks.h"
#include "hal/shown_text.h"

namespace jaywalk::sim {
namespace {

/// Seconds that a count of nanoseconds in 64 bits holds, with room for sums: about 146 years.
constexpr double kMaxSeconds = 4.6e9;

/// Longest line that is read; a scan of 2,048 beams takes about 16 kB.
constexpr std::size_t kMaxLineBytes = 1U << 20U;
constexpr std::size_t kBlockBytes = 1U << 16U;

}  // namespace

LineFile::LineFile(const std::filesystem::path& file, const std::string& expected) : file_(file) {
  require_readable(file, name() + ": ", expected);
  stream_.emplace(file.c_str());
}

bool LineFile::next_line() {
  text_.clear();
  ++line_;
  for (bool ended = false; !ended;) {
    if (taken_ == block_.size()) {
      block_.resize(kBlockBytes);
      block_.resize(stream_->read(block_.data(), kBlockBytes));
      taken_ = 0;
      if (stream_->broken()) refuse("the compressed file is damaged or cut", "fetch it again");
      if (block_.empty() && text_.empty()) return false;
      if (block_.empty()) break;
    }
    const std::string_view rest = std::string_view(block_).substr(taken_);
    const std::string_view part = rest.substr(0, rest.find('\n'));
    ended = part.size() < rest.size();
    if (text_.size() + part.size() > kMaxLineBytes) refuse("a line of over 1 MiB", "give a text file");
    text_.append(part);
    taken_ += part.size() + (ended ? 1 : 0);
  }
  if (!text_.empty() && text_.back() == '\r') text_.pop_back();
  if (line_ == 1) drop_byte_order_mark(text_);
  return true;
}

void LineFile::split() {
  words_.clear();
  constexpr std::string_view kBlank = " \t\r";
  const bool commas = has_commas();
  const std::string_view text = text_;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find_first_of(commas ? "," : kBlank, begin), text.size());
    const std::string_view field = text.substr(begin, end - begin);
    const std::size_t first = std::min(field.find_first_not_of(kBlank), field.size());
    if (commas || !field.empty()) words_.push_back(field.substr(first, field.find_last_not_of(kBlank) + 1 - first));
    begin = end + 1;
  }
}

bool LineFile::next() {
  while (next_line()) {
    split();
    if (!words_.empty() && !words_.front().starts_with('#')) return true;
  }
  return false;
}

double LineFile::number(std::size_t i) const {
  const auto value = number_in<double>(words_[i]);
  if (!value)
    refuse("'" + shown(words_[i]) + "' (word " + std::to_string(i + 1) + ") is not a number",
           "repair or delete the line");
  return *value;
}

std::size_t LineFile::count(std::size_t i, std::size_t most) const {
  const double value = number(i);
  if (!(value >= 0.0 && value <= static_cast<double>(most)) || std::floor(value) != value) {
    refuse("a count of " + shown(words_[i]) + ", 0 to " + std::to_string(most) + " expected",
           "repair or delete the line");
  }
  return static_cast<std::size_t>(value);
}

double LineFile::seconds(std::size_t i) const {
  const double value = number(i);
  if (!(std::fabs(value) <= kMaxSeconds)) refuse("a time of " + shown(words_[i]) + " s", "give times in seconds");
  return value;
}

}  // namespace jaywalk::sim
