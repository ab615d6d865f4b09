#include "tests/drivers/eds_file.h"

#include <array>
#include <charconv>
#include <fstream>
#include <optional>

#include "drivers/canopen/cia402.h"
#include "hal/types/errors.h"

namespace jaywalk::canopen {

namespace {

constexpr std::array kForDriving{
    NeededObject{kControlword, true, "state machine"},
    NeededObject{kStatusword, false, "state machine"},
    NeededObject{kModeWanted, true, "choice of profile velocity"},
    NeededObject{kModeShown, false, "choice of profile velocity"},
    NeededObject{kTargetVelocity, true, "profile velocity"},
    NeededObject{kVelocity, false, "wheel speed"},
    NeededObject{kPosition, false, "wheel angle"},
};
constexpr std::array kForProof{
    NeededObject{{0x1016, 1}, true, "watching the controller's heartbeat"},
    NeededObject{{0x1017, 0}, true, "the drive's own heartbeat"},
    NeededObject{kAbortConnection, true, "what happens when the heartbeat is lost"},
    NeededObject{kQuickStopOption, true, "quick stop"},
    NeededObject{kShutdownOption, true, "stop at shutdown"},
    NeededObject{kDisableOption, true, "stop when disabled"},
    NeededObject{kHaltOption, true, "halt"},
    NeededObject{kFaultOption, true, "stop at a fault"},
    NeededObject{kProfileDeceleration, true, "braking ramp"},
    NeededObject{kQuickStopDeceleration, true, "quick stop ramp"},
};

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

std::string lower(std::string text) {
  for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return text;
}

/// The whole of `text` as a hexadecimal number of up to `digits` digits.
std::optional<unsigned> hexadecimal(const std::string& text, std::size_t digits) {
  unsigned value = 0;
  const char* const end = text.data() + text.size();
  const auto parsed = std::from_chars(text.data(), end, value, 16);
  if (text.empty() || text.size() > digits || parsed.ec != std::errc{} || parsed.ptr != end) return std::nullopt;
  return value;
}

/// "6040" or "1016sub1"; nothing for the sections that describe no object.
std::optional<ObjectAddress> address_of(const std::string& section) {
  const std::string text = lower(section);
  const auto sub_at = text.find("sub");
  const auto index = hexadecimal(text.substr(0, sub_at), 4);
  const auto sub = sub_at == std::string::npos ? 0U : hexadecimal(text.substr(sub_at + 3), 2);
  if (!index || !sub) return std::nullopt;
  return ObjectAddress{static_cast<std::uint16_t>(*index), static_cast<std::uint8_t>(*sub)};
}

void set_property(ObjectEntry& entry, const std::string& line) {
  const auto equals = line.find('=');
  if (equals == std::string::npos) return;
  const std::string key = lower(trimmed(line.substr(0, equals)));
  if (key == "parametername") entry.name = trimmed(line.substr(equals + 1));
  if (key == "accesstype") entry.access = lower(trimmed(line.substr(equals + 1)));
}

enum class Offer { kNone, kFixed, kFull };

Offer offer_of(const EdsFile& eds, const NeededObject& needed) {
  const ObjectEntry* const entry = eds.find(needed.address);
  if (entry == nullptr || (!entry->is_readable() && !entry->is_writable())) return Offer::kNone;
  return needed.writable && !entry->is_writable() ? Offer::kFixed : Offer::kFull;
}

}  // namespace

EdsFile::EdsFile(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw StartupError(file.string() + ": cannot be read", "name the EDS file that the drive's maker gives out");
  ObjectEntry* current = nullptr;
  std::string raw;
  for (int number = 1; std::getline(in, raw); ++number) {
    const std::string line = trimmed(raw);
    if (line.empty() || line.front() == ';') continue;
    if (line.front() != '[') {
      if (current != nullptr) set_property(*current, line);
      continue;
    }
    const std::string place = file.string() + ":" + std::to_string(number);
    if (line.back() != ']') throw StartupError(place + ": a section without ]", "use the maker's file unchanged");
    const auto address = address_of(line.substr(1, line.size() - 2));
    current = nullptr;
    if (!address) continue;
    const auto [at, is_new] = objects_.try_emplace(*address);
    // The head of an array and its sub-index 0 share an address; the latter says more.
    if (!is_new && !at->second.access.empty())
      throw StartupError(place + ": object stands twice", "use the maker's file unchanged");
    current = &at->second;
    current->line = number;
  }
  if (objects_.empty()) throw StartupError(file.string() + ": no object in it", "name an EDS file (CiA 306)");
}

const ObjectEntry* EdsFile::find(ObjectAddress address) const {
  const auto found = objects_.find(address);
  return found == objects_.end() ? nullptr : &found->second;
}

DriveShortcomings shortcomings(const EdsFile& eds) {
  DriveShortcomings lacks;
  for (const NeededObject& needed : kForDriving) {
    if (offer_of(eds, needed) != Offer::kFull) lacks.for_driving.push_back(needed);
  }
  for (const NeededObject& needed : kForProof) {
    const Offer offer = offer_of(eds, needed);
    if (offer == Offer::kNone) lacks.for_proof.push_back(needed);
    if (offer == Offer::kFixed) lacks.fixed_for_proof.push_back(needed);
  }
  return lacks;
}

}  // namespace jaywalk::canopen
