#include "apps/formats/logs/line_file.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "hal/shown_text.h"
#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

/// Seconds that a count of nanoseconds in 64 bits holds, with room for sums: about 146 years.
constexpr double kMaxSeconds = 4.6e9;

}  // namespace

struct TextLines::Stream {
  GzipFile file;
  std::array<char, 1U << 16U> block{};
  std::size_t used = 0, size = 0;

  explicit Stream(const char* path) : file(path) {}

  /// Reads another block; false at the end.
  bool refill() {
    used = 0;
    size = file.read(block.data(), block.size());
    return size > 0;
  }
};

TextLines::TextLines(const std::filesystem::path& file, const std::string& expected) : file_(file) {
  require_readable(file, name() + ": ", expected);
  stream_ = std::make_unique<Stream>(file.c_str());
}

TextLines::~TextLines() = default;

bool TextLines::next() {
  text_.clear();
  ++line_;
  for (bool ended = false; !ended;) {
    if (stream_->used == stream_->size) {
      const bool more = stream_->refill();
      if (stream_->file.broken()) refuse("the compressed file is damaged or cut", "fetch it again");
      if (!more && text_.empty()) return false;
      if (!more) break;
    }
    const std::string_view rest(stream_->block.data() + stream_->used, stream_->size - stream_->used);
    const std::size_t end = rest.find('\n');
    ended = end != std::string_view::npos;
    const std::size_t taken = ended ? end : rest.size();
    if (text_.size() + taken > kMaxLineBytes) refuse("a line of over 1 MiB", "give a text file");
    text_.append(rest.substr(0, taken));
    stream_->used += taken + (ended ? 1 : 0);
  }
  if (!text_.empty() && text_.back() == '\r') text_.pop_back();
  if (line_ == 1) drop_byte_order_mark(text_);
  return true;
}

void LineFile::split() {
  words_.clear();
  constexpr std::string_view kBlank = " \t\r";
  const std::string_view text = lines_.text();
  if (has_commas()) {
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(',', begin), text.size());
      const std::string_view field = text.substr(begin, end - begin);
      const std::size_t first = std::min(field.find_first_not_of(kBlank), field.size());
      words_.push_back(field.substr(first, field.find_last_not_of(kBlank) + 1 - first));
      begin = end + 1;
    }
    return;
  }
  std::size_t begin = text.find_first_not_of(kBlank);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlank, begin), text.size());
    words_.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(kBlank, end);
  }
}

bool LineFile::next() {
  while (lines_.next()) {
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
