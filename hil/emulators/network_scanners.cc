#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "hal/types/trig.h"
#include "hil/emulators/scanners.h"

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

constexpr double kRadPerTdeg = kPi / 1.8e6;
constexpr std::uint32_t kClockAtStart_us = 0xFFFFFFFFU - 10'000'000U;

SweepShape shape_of(const SickModel& model) {
  const double swept_rad = model.step_tdeg * kRadPerTdeg * (model.beams - 1.0);
  return {.beams = model.beams,
          .first_angle_rad = (model.first_angle_tdeg - 900000.0) * kRadPerTdeg,
          .angle_step_rad = model.step_tdeg * kRadPerTdeg,
          .rate_hz = model.rate_hz,
          .sweep = duration_from_seconds(swept_rad / (2.0 * kPi) / model.rate_hz)};
}

/// Fields of a telegram as a dialect writes them.
class Fields {
 public:
  explicit Fields(ColaDialect dialect) : dialect_(dialect) {}
  void number(std::uint32_t value, int bytes) {
    if (dialect_ == ColaDialect::kText) {
      char digits[16];
      std::snprintf(digits, sizeof digits, " %X", static_cast<unsigned>(value));
      made_ += made_.empty() ? digits + 1 : digits;
      return;
    }
    for (int k = bytes - 1; k >= 0; --k) made_ += static_cast<char>(value >> (8 * k));
  }
  void numbers(std::initializer_list<Number> all) {
    for (const Number& each : all) number(static_cast<std::uint32_t>(each.value), each.bytes);
  }
  void word(const char* letters) {
    if (dialect_ == ColaDialect::kText) made_ += ' ';
    made_ += letters;
  }
  [[nodiscard]] const std::string& made() const { return made_; }

 private:
  ColaDialect dialect_;
  std::string made_;
};

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
    return answer(command + (speaks_scip_2_ ? "\n0\n\n" : "\nE\n\n"));
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
  answer(command + '\n' + with_sum(status) + '\n' + lines + '\n');
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

ScannerServer::Message ScipServer::message_of(std::size_t, Ranges range_m, Time began, Time) {
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

SickServer::SickServer(std::unique_ptr<ByteServer> wire, const SickModel& model, World world)
    : ScannerServer(std::move(wire), shape_of(model), model.beams, std::move(world)), model_(model) {}

void SickServer::on_new_peer() {
  came_in_.clear();
  logged_in_ = false;
}

void SickServer::on_bytes(wire::Bytes bytes) {
  came_in_.append(bytes.begin(), bytes.end());
  std::string command;
  while (take_command(command)) obey(command);
}

bool SickServer::take_command(std::string& command) {
  if (model_.dialect == ColaDialect::kText) {
    const std::size_t begin = came_in_.find('\x02');
    const std::size_t end = came_in_.find('\x03', begin == std::string::npos ? 0 : begin);
    if (begin == std::string::npos || end == std::string::npos) return false;
    command = came_in_.substr(begin + 1, end - begin - 1);
    came_in_.erase(0, end + 1);
    return true;
  }
  if (came_in_.size() < 8) return false;
  const std::size_t length = static_cast<unsigned char>(came_in_[7]);  // no command is longer than 255
  if (came_in_.size() < length + 9) return false;
  command = came_in_.substr(8, length);
  came_in_.erase(0, length + 9);
  return true;
}

void SickServer::obey(std::string_view command) {
  const bool text = model_.dialect == ColaDialect::kText;
  const std::string yes = text ? " 1" : " \x01";
  const std::string_view kind = command.substr(0, 3);
  std::string_view rest = command.size() > 4 ? command.substr(4) : std::string_view();
  const std::string_view word = rest.substr(0, rest.find(' '));
  const std::string_view argument = rest.size() > word.size() ? rest.substr(word.size() + 1) : std::string_view();
  const std::string password = text ? "03 F4724744" : "\x03\xF4\x72\x47\x44";
  if (!ignored_word_.empty() && word == ignored_word_) return;
  if (!refused_word_.empty() && word == refused_word_) return say(text ? "sFA 3" : std::string_view("sFA \x00\x03", 6));
  if (kind == "sMN" && word == "SetAccessMode") {
    logged_in_ = argument == password;
    return say("sAN SetAccessMode" + (logged_in_ ? yes : std::string(text ? " 0" : std::string(" \0", 2))));
  }
  if (kind == "sWN" && logged_in_ && (word == "LMDscandatacfg" || word == "LMPoutputRange"))
    return say("sWA " + std::string(word));
  if (kind == "sMN" && word == "Run") return say("sAN Run" + yes);
  if (kind == "sEN" && word == "LMDscandata") {
    set_streaming(argument == yes.substr(1));
    return say("sEA LMDscandata " + std::string(argument));
  }
  say(text ? "sFA 1" : std::string_view("sFA \x00\x01", 6));
}

std::string SickServer::framed(std::string_view body) const {
  if (model_.dialect == ColaDialect::kText) return "\x02" + std::string(body) + "\x03";
  std::string telegram("\x02\x02\x02\x02");
  for (int shift = 24; shift >= 0; shift -= 8) telegram += static_cast<char>(body.size() >> shift);
  char sum = 0;
  for (const char c : body) sum = static_cast<char>(sum ^ c);
  return telegram + std::string(body) + sum;
}

ScannerServer::Message SickServer::message_of(std::size_t, Ranges range_m, Time began, Time now) {
  const auto on_device = [](Time t) {
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(t.time_since_epoch()).count();
    return kClockAtStart_us + static_cast<std::uint32_t>(us);
  };
  Fields fields(model_.dialect);
  const std::uint32_t dirt = window_ == Window::kClean ? 0 : window_ == Window::kSoiled ? 2 : 4;
  const auto rate_chz = static_cast<std::uint32_t>(std::floor(model_.rate_hz * 100.0 + 0.5));
  fields.numbers({{1, 2}, {1, 2}, {0x00E0FFEE, 4}, {0, 1}, {(unwell_ ? 1U : 0U) | dirt, 1}});
  fields.numbers({{++telegrams_, 2}, {++sweeps_, 2}, {on_device(began + shape().sweep), 4}, {on_device(now), 4}});
  fields.numbers({{0, 1}, {0, 1}, {0, 1}, {0, 1}, {0, 2}});   // inputs and outputs
  fields.numbers({{rate_chz, 4}, {162, 4}, {0, 2}, {1, 2}});  // no encoders, one channel of 16 bits
  fields.word("DIST1");
  fields.numbers({{0x3F800000, 4}, {0, 4}});  // millimetres
  fields.numbers({{static_cast<std::uint32_t>(model_.first_angle_tdeg), 4}, {model_.step_tdeg, 2}, {model_.beams, 2}});
  for (const float m : range_m) {
    constexpr std::uint32_t kNoEcho = 0, kNotMeasured = 2;  // the latter as a recorded TiM has it
    const bool seen = static_cast<double>(m) <= model_.range_max_m && m > 0.0F;
    fields.number(seen ? in_counts(m, 0.001) : m > 0.0F ? kNoEcho : kNotMeasured, 2);
  }
  fields.numbers(
      {{0, 2}, {0, 2}, {0, 2}, {0, 2}, {0, 2}, {0, 2}});  // channels of 8 bits, position, name, comment, time, event
  const std::string telegram = framed("sSN LMDscandata " + fields.made());
  return {telegram.begin(), telegram.end()};
}

}  // namespace jaywalk::emulators
