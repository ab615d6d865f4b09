#include "hal/sim/logs/line_file.h"

#include <zlib.h>

#include <array>
#include <charconv>
#include <cmath>

#include "hal/types/errors.h"

namespace jaywalk::sim {
namespace {

/// Seconds that a count of nanoseconds in 64 bits holds, with room for sums: about 146 years.
constexpr double kMaxSeconds = 4.6e9;

}  // namespace

struct LineFile::Stream {
  gzFile file = nullptr;
  std::array<char, 1U << 16U> block{};
  std::size_t used = 0, size = 0;

  explicit Stream(const char* path) : file(gzopen(path, "rb")) {}
  ~Stream() {
    if (file != nullptr) gzclose(file);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// Reads another block; false at the end. `broken` when zlib says so, or the .gz stops half way.
  bool refill(bool& broken) {
    const int got = gzread(file, block.data(), static_cast<unsigned>(block.size()));
    used = 0;
    size = got > 0 ? static_cast<std::size_t>(got) : 0;
    int error = Z_OK;
    gzerror(file, &error);
    broken = got < 0 || (error != Z_OK && error != Z_STREAM_END);
    return size > 0;
  }
};

LineFile::LineFile(const std::filesystem::path& file) : file_(file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw StartupError(name() + ": no such file", "give the path of a recording");
  }
  stream_ = std::make_unique<Stream>(file.c_str());
  if (stream_->file == nullptr) throw StartupError(name() + ": cannot be read", "check its permissions");
}

LineFile::~LineFile() = default;

void LineFile::refuse(const std::string& cause, const std::string& remedy) const {
  throw StartupError(name() + ":" + std::to_string(line_) + ": " + cause, remedy);
}

bool LineFile::read_line() {
  text_.clear();
  ++line_;
  while (true) {
    if (stream_->used == stream_->size) {
      bool broken = false;
      const bool more = stream_->refill(broken);
      if (broken) refuse("the compressed file is damaged or cut", "fetch it again");
      if (!more) return !text_.empty();
    }
    const std::string_view rest(stream_->block.data() + stream_->used, stream_->size - stream_->used);
    const std::size_t end = rest.find('\n');
    const std::size_t taken = end == std::string_view::npos ? rest.size() : end;
    if (text_.size() + taken > kMaxLineBytes) refuse("a line of over 1 MiB", "give a text recording");
    text_.append(rest.substr(0, taken));
    stream_->used += taken;
    if (end == std::string_view::npos) continue;
    ++stream_->used;
    return true;
  }
}

void LineFile::split() {
  words_.clear();
  constexpr std::string_view kBlank = " \t\r";
  const std::string_view text = text_;
  std::size_t begin = text.find_first_not_of(kBlank);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(text.find_first_of(kBlank, begin), text.size());
    words_.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(kBlank, end);
  }
}

bool LineFile::next() {
  while (read_line()) {
    split();
    if (!words_.empty() && words_.front().front() != '#') return true;
  }
  return false;
}

double LineFile::number(std::size_t i) const {
  const std::string_view word = words_[i];
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    const std::string shown(word.substr(0, 40));
    refuse("'" + shown + "' (word " + std::to_string(i + 1) + ") is not a number", "repair or delete the line");
  }
  return value;
}

std::size_t LineFile::count(std::size_t i, std::size_t most) const {
  const double value = number(i);
  if (!(value >= 0.0 && value <= static_cast<double>(most)) || std::floor(value) != value) {
    const std::string shown(words_[i].substr(0, 40));
    refuse("a count of " + shown + ", 0 to " + std::to_string(most) + " expected", "repair or delete the line");
  }
  return static_cast<std::size_t>(value);
}

double LineFile::seconds(std::size_t i) const {
  const double value = number(i);
  if (!(std::fabs(value) <= kMaxSeconds)) {
    refuse("a time of " + std::string(words_[i].substr(0, 40)) + " s", "give times in seconds");
  }
  return value;
}

}  // namespace jaywalk::sim
