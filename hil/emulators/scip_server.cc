#include "hil/emulators/scip_server.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "hal/types/trig.h"

namespace jaywalk::emulators {
namespace {

constexpr std::uint32_t kClockAtStart_ms = (1U << 24U) - 2000U;
constexpr std::size_t kLine = 64;

SweepShape shape_of(const ScipModel& model) {
  const double step_rad = 2.0 * kPi / model.steps_per_turn;
  const double rate_hz = model.turns_per_minute / 60.0;
  const double steps = static_cast<double>(model.last_step) - model.first_step;
  return {.beams = model.last_step - model.first_step + 1,
          .first_angle_rad = (static_cast<double>(model.first_step) - model.front_step) * step_rad,
          .angle_step_rad = step_rad,
          .rate_hz = rate_hz,
          .sweep = duration_from_seconds(steps / model.steps_per_turn / rate_hz)};
}

std::string with_sum(const std::string& line) {
  unsigned sum = 0;
  for (const char c : line) sum += static_cast<unsigned char>(c);
  return line + static_cast<char>(0x30 + sum % 64);
}

std::string characters(std::uint32_t number, int count) {
  std::string made;
  for (int k = count - 1; k >= 0; --k) made += static_cast<char>(0x30 + (number >> (6 * k)) % 64);
  return made;
}

}  // namespace

ScipServer::ScipServer(std::unique_ptr<ByteServer> wire, const ScipModel& model, World world)
    : ScannerServer(std::move(wire), shape_of(model), model.last_step - model.first_step + 1, std::move(world)),
      model_(model) {}

void ScipServer::on_bytes(wire::Bytes bytes) {
  came_in_.append(bytes.begin(), bytes.end());
  for (std::size_t end = came_in_.find('\n'); end != std::string::npos; end = came_in_.find('\n')) {
    obey(came_in_.substr(0, end));
    came_in_.erase(0, end + 1);
  }
}

void ScipServer::obey(const std::string& command) {
  if (!speaks_scip_2_) {
    speaks_scip_2_ = command == "SCIP2.0";
    const std::string answered = command + (speaks_scip_2_ ? "\n0\n\n" : "\nE\n\n");
    return answer({reinterpret_cast<const std::uint8_t*>(answered.data()), answered.size()});
  }
  if (command == "QT") {
    set_streaming(false);
    laser_on_ = false;
    return say(command, "00");
  }
  if (command == "PP") return say(command, "00", parameters());
  if (command == "BM") {
    if (broken_) return say(command, "01");
    return say(command, std::exchange(laser_on_, true) ? "02" : "00");
  }
  if (command.substr(0, 2) == "MD" && command.size() == 15) return begin_scans(command);
  say(command, "0E");
}

void ScipServer::begin_scans(const std::string& command) {
  const auto number = [&command](std::size_t at, std::size_t digits) {
    return static_cast<std::uint32_t>(std::strtoul(command.substr(at, digits).c_str(), nullptr, 10));
  };
  first_ = number(2, 4);
  last_ = number(6, 4);
  joined_ = std::max(number(10, 2), 1U);
  if (first_ < model_.first_step || last_ > model_.last_step || last_ <= first_) return say(command, "04");
  asked_ = command;
  say(command, "00");
  set_streaming(laser_on_);
}

void ScipServer::say(const std::string& command, const std::string& status, const std::string& lines) {
  const std::string text = command + '\n' + with_sum(status) + '\n' + lines + '\n';
  answer({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::string ScipServer::parameters() const {
  const auto line = [](const std::string& text) { return text + ';' + with_sum(text).back() + '\n'; };
  const auto value = [&line](const char* name, std::uint32_t v) { return line(name + std::to_string(v)); };
  return line("MODL:UTM-30LX(emulated)") + value("DMIN:", model_.range_min_mm) + value("DMAX:", model_.range_max_mm) +
         value("ARES:", model_.steps_per_turn) + value("AMIN:", model_.first_step) + value("AMAX:", model_.last_step) +
         value("AFRT:", model_.front_step) + value("SCAN:", model_.turns_per_minute);
}

/// What it says for steps that are joined: the nearest distance, or else a code of the UTM-30LX.
std::uint32_t ScipServer::joined_mm(std::span<const float> range_m) const {
  constexpr std::uint32_t kNothingInRange = 1, kMeasurementError = 3;
  std::uint32_t nearest = model_.range_max_mm + 1;
  bool measured = true;
  for (const float m : range_m) {
    measured = measured && m > 0.0F;
    if (m > 0.0F && std::isfinite(m)) nearest = std::min(nearest, in_counts(m, 0.001));
  }
  if (nearest <= model_.range_max_mm) return std::max(nearest, model_.range_min_mm);
  return measured ? kNothingInRange : kMeasurementError;
}

std::vector<std::uint8_t> ScipServer::message_of(std::size_t, std::span<const float> range_m, Time began, Time) {
  if (!status_.empty()) {
    const std::string refusal = asked_ + '\n' + with_sum(status_) + "\n\n";
    return {refusal.begin(), refusal.end()};
  }
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(began.time_since_epoch()).count();
  std::string text = asked_ + '\n' + with_sum("99") + '\n' +
                     with_sum(characters(kClockAtStart_ms + static_cast<std::uint32_t>(ms), 4)) + '\n';
  std::string distances;
  for (std::uint32_t step = first_; step <= last_; step += joined_) {
    const std::uint32_t end = std::min(step + joined_, last_ + 1);
    distances += characters(joined_mm(range_m.subspan(step - model_.first_step, end - step)), 3);
  }
  for (std::size_t at = 0; at < distances.size(); at += kLine) text += with_sum(distances.substr(at, kLine)) + '\n';
  text += '\n';
  return {text.begin(), text.end()};
}

}  // namespace jaywalk::emulators
