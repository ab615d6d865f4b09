#include "apps/view/frame_store.h"

#include <unistd.h>

#include <algorithm>

namespace jaywalk::view {
FrameStore::Piece FrameStore::put(std::string_view text) {
  const Piece piece{.at = size_, .size = static_cast<std::uint32_t>(text.size())};
  while (!full_ && !text.empty()) {
    const ssize_t written = ::pwrite(fileno(file_.get()), text.data(), text.size(), static_cast<off_t>(size_));
    full_ = written <= 0 || size_ > kMostBytes;
    if (full_) return {};
    size_ += static_cast<std::uint64_t>(written);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  return piece;
}

std::string FrameStore::read(const Piece& piece) const {
  std::string text(piece.size, '\0');
  const ssize_t got = ::pread(fileno(file_.get()), text.data(), text.size(), static_cast<off_t>(piece.at));
  return got == static_cast<ssize_t>(piece.size) ? text : "";
}

void FrameStore::add_field(std::string_view field) {
  const std::scoped_lock lock(mutex_);
  field_ = put(field);
}

void FrameStore::add_scene(std::string_view scene) {
  const std::scoped_lock lock(mutex_);
  scene_ = put(scene);
}

void FrameStore::add(const StripTick& strip, std::string_view head) {
  const std::scoped_lock lock(mutex_);
  const Entry entry{.strip = strip, .head = put(head), .scene = scene_, .field = field_};
  if (!full_) entries_.push_back(entry);
}

std::string FrameStore::then(std::uint64_t tick) const {
  const std::scoped_lock lock(mutex_);
  if (tick >= entries_.size()) return "";
  const Entry& entry = entries_[tick];
  const std::string head = read(entry.head), scene = read(entry.scene);
  if (head.empty() || scene.empty()) return "";
  const std::string field = entry.field.size == 0 ? "null" : read(entry.field);
  return R"({"kind":"then","frame":)" + head + scene + R"(},"field":)" + (field.empty() ? "null" : field) + "}";
}

std::string FrameStore::past(std::size_t most) const {
  const std::scoped_lock lock(mutex_);
  const std::size_t step = std::max<std::size_t>(1, (entries_.size() + most - 1) / most);
  std::string text = R"({"kind":"past","step":)" + std::to_string(step) + R"(,"ticks":[)";
  for (std::size_t k = 0; k < entries_.size(); k += step) {
    const StripTick& strip = entries_[k].strip;
    char row[96];
    std::snprintf(row, sizeof row, "%s[%.2f,%.3f,%.3f,%.3f,\"", k == 0 ? "" : ",", strip.t_s, strip.wanted_mps,
                  strip.permitted_mps, strip.speed_mps);
    text += row + to_string(strip.reasons);
    std::snprintf(row, sizeof row, "\",%.2f,%.2f]", strip.at.x, strip.at.y);
    text += row;
  }
  return text + "]}";
}

}  // namespace jaywalk::view
