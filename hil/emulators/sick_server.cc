#include "hil/emulators/sick_server.h"

#include <cmath>
#include <cstdio>

#include "hal/types/trig.h"

namespace jaywalk::emulators {
namespace {

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

/// Cuts the next whole command off what came in.
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

void SickServer::say(std::string_view body) {
  const std::string telegram = framed(body);
  answer({reinterpret_cast<const std::uint8_t*>(telegram.data()), telegram.size()});
}

std::string SickServer::framed(std::string_view body) const {
  if (model_.dialect == ColaDialect::kText) return "\x02" + std::string(body) + "\x03";
  std::string telegram("\x02\x02\x02\x02");
  for (int shift = 24; shift >= 0; shift -= 8) telegram += static_cast<char>(body.size() >> shift);
  char sum = 0;
  for (const char c : body) sum = static_cast<char>(sum ^ c);
  return telegram + std::string(body) + sum;
}

std::vector<std::uint8_t> SickServer::message_of(std::size_t, std::span<const float> range_m, Time began, Time now) {
  const auto on_device = [](Time t) {
    const auto us = std::chrono::duration_cast<std::chrono::microseconds>(t.time_since_epoch()).count();
    return kClockAtStart_us + static_cast<std::uint32_t>(us);
  };
  Fields fields(model_.dialect);
  fields.number(1, 2);
  fields.number(1, 2);
  fields.number(0x00E0FFEE, 4);
  fields.number(0, 1);
  const std::uint32_t dirt = window_ == Window::kClean ? 0 : window_ == Window::kSoiled ? 2 : 4;
  fields.number((unwell_ ? 1U : 0U) | dirt, 1);
  fields.number(++telegrams_, 2);
  fields.number(++sweeps_, 2);
  fields.number(on_device(began + shape().sweep), 4);
  fields.number(on_device(now), 4);
  for (int inputs_and_outputs = 0; inputs_and_outputs < 4; ++inputs_and_outputs) fields.number(0, 1);
  fields.number(0, 2);
  fields.number(static_cast<std::uint32_t>(std::floor(model_.rate_hz * 100.0 + 0.5)), 4);
  fields.number(162, 4);
  fields.number(0, 2);  // encoders
  fields.number(1, 2);  // channels of 16 bits
  fields.word("DIST1");
  fields.number(0x3F800000, 4);  // millimetres
  fields.number(0, 4);
  fields.number(static_cast<std::uint32_t>(model_.first_angle_tdeg), 4);
  fields.number(model_.step_tdeg, 2);
  fields.number(model_.beams, 2);
  for (const float m : range_m) {
    constexpr std::uint32_t kNoEcho = 0, kNotMeasured = 2;  // the latter as a recorded TiM has it
    const bool seen = static_cast<double>(m) <= model_.range_max_m && m > 0.0F;
    fields.number(seen ? in_counts(m, 0.001) : m > 0.0F ? kNoEcho : kNotMeasured, 2);
  }
  for (int k = 0; k < 6; ++k) fields.number(0, 2);  // channels of 8 bits, position, name, comment, time, event
  const std::string telegram = framed("sSN LMDscandata " + fields.made());
  return {telegram.begin(), telegram.end()};
}

}  // namespace jaywalk::emulators
