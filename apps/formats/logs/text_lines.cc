#include "apps/formats/logs/text_lines.h"

#include <array>
#include <string_view>

#include "hal/text_file.h"
#include "hal/types/errors.h"

namespace jaywalk::sim {

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

void TextLines::refuse(const std::string& cause, const std::string& remedy) const {
  throw StartupError(name() + ":" + std::to_string(line_) + ": " + cause, remedy);
}

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

}  // namespace jaywalk::sim
