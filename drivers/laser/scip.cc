#include "drivers/laser/scip.h"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <span>
#include <utility>

#include "hal/shown_text.h"
#include "hal/types/trig.h"

namespace jaywalk::scip {
namespace {

constexpr std::size_t kLongestData = 64;
constexpr std::uint32_t kLastCode = 19;                             // of the URG-04LX; C-42-03320B, 6, tables 3 and 4
constexpr std::uint32_t kNothingInRange = 1;                        // UTM-30LX
constexpr std::uint32_t kNoEchoFirst = 65533, kNoEchoLast = 65535;  // of SCIP 2.2: nothing there, or too dark

/// What was asked, as the answer's first line repeats it: "MD" first step, last step, steps to a beam.
struct Question {
  std::uint32_t first_step = 0;
  std::uint32_t last_step = 0;
  std::uint32_t cluster = 1;
  std::size_t characters = 3;  ///< to a distance
};

/// Takes the next line off `rest`.
std::string_view take_line(std::string_view& rest) noexcept {
  const std::string_view line = rest.substr(0, rest.find('\n'));
  rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  return line;
}

bool is_scan_command(std::string_view echo) noexcept {
  const std::string_view command = echo.substr(0, 2);
  return command == "MD" || command == "MS" || command == "GD" || command == "GS";
}

std::optional<Question> parse_question(std::string_view echo, const ScannerModel& model) noexcept {
  if (echo.size() < 12) return std::nullopt;
  const auto first = number_in<std::uint32_t>(echo.substr(2, 4));
  const auto last = number_in<std::uint32_t>(echo.substr(6, 4));
  const auto cluster = number_in<std::uint32_t>(echo.substr(10, 2));
  if (!first || !last || !cluster || *last < *first || *last > model.last_step) return std::nullopt;
  return Question{*first, *last, std::max(*cluster, 1U), echo[1] == 'D' ? std::size_t{3} : std::size_t{2}};
}

/// The line without its checksum; nothing where that is wrong.
std::optional<std::string_view> checked(std::string_view line) noexcept {
  if (line.size() < 2 || checksum(line.substr(0, line.size() - 1)) != line.back()) return std::nullopt;
  return line.substr(0, line.size() - 1);
}

/// `one_means_nothing`: as in ScannerModel.
float range_of(std::uint32_t value, bool one_means_nothing) noexcept {
  if (value == kNothingInRange && one_means_nothing) return std::numeric_limits<float>::infinity();
  const bool is_code = value <= kLastCode || (value >= kNoEchoFirst && value <= kNoEchoLast);
  return is_code ? 0.0F : static_cast<float>(value) * 0.001F;
}

// Numbers may begin on one line and end on the next. Of joined steps one that is in error may hide what the others saw:
// there a code is only a code.
bool read_distances(std::string_view rest, const Question& question, const ScannerModel& model,
                    LaserScan& scan) noexcept {
  const bool one_means_nothing = model.one_means_nothing && question.cluster == 1;
  std::uint32_t value = 0;
  std::size_t gathered = 0;  // characters of the value
  scan.beam_count = 0;
  while (!rest.empty()) {
    const auto line = checked(take_line(rest));
    if (!line || line->size() > kLongestData) return false;
    for (const char c : *line) {
      const auto bits = decode_number({&c, 1});
      if (!bits) return false;
      value = value << 6U | *bits;
      if (++gathered < question.characters) continue;
      if (scan.beam_count == kMaxBeams) return false;
      scan.range_m[scan.beam_count++] = range_of(std::exchange(value, 0), one_means_nothing);
      gathered = 0;
    }
  }
  const std::uint32_t expected = (question.last_step - question.first_step) / question.cluster + 1;
  return gathered == 0 && scan.beam_count == expected;
}

/// What PP tells, in its own names and units.
struct Told {
  std::string_view name;
  std::uint32_t least, most;
  std::optional<std::uint32_t> value;
};

/// "MODL:UTM-30LX(Hokuyo Automatic Co.,Ltd.)"; not the UTM-30LX-EW, whose codes are others.
bool names_utm_30lx(std::string_view text) noexcept { return text.substr(0, text.find('(')) == "MODL:UTM-30LX"; }

/// "DMIN:20;4" into the one of `wanted` that has this name; false where it is malformed or out of range.
bool take_value(std::string_view line, std::span<Told> wanted) noexcept {
  const std::size_t semicolon = line.rfind(';');
  if (semicolon == std::string_view::npos || semicolon + 2 != line.size()) return false;
  const std::string_view text = line.substr(0, semicolon);
  if (checksum(text) != line.back()) return false;
  const std::size_t colon = text.find(':');
  for (Told& told : wanted) {
    if (text.substr(0, colon) != told.name) continue;
    told.value = number_in<std::uint32_t>(text.substr(colon + 1));
    if (!told.value || *told.value < told.least || *told.value > told.most) return false;
  }
  return true;
}

void place(const Question& question, const ScannerModel& model, Time arrival, LaserScan& scan) noexcept {
  const double step_rad = 2.0 * kPi / static_cast<double>(model.steps_per_turn);
  const double ahead = static_cast<double>(question.first_step) - static_cast<double>(model.front_step);
  const double swept = static_cast<double>(question.last_step - question.first_step);
  scan.first_angle_rad = static_cast<float>(ahead * step_rad);
  scan.angle_step_rad = static_cast<float>(step_rad * static_cast<double>(question.cluster));
  scan.period = model.period;
  scan.sweep = duration_from_seconds(to_seconds(model.period) * swept / static_cast<double>(model.steps_per_turn));
  scan.stamp = arrival - scan.sweep;
  scan.range_min_m = model.range_min_m;
  scan.range_max_m = model.range_max_m;
}

/// More scans than this do not go missing on a connection that lives: the scanner began to count anew.
constexpr std::uint32_t kMostLost = 1000;

}  // namespace

char checksum(std::string_view line) noexcept {
  unsigned sum = 0;
  for (const char c : line) sum += static_cast<unsigned char>(c);
  return static_cast<char>((sum & 0x3FU) + 0x30U);
}

std::optional<std::uint32_t> decode_number(std::string_view characters) noexcept {
  if (characters.empty() || characters.size() > 5) return std::nullopt;
  std::uint32_t value = 0;
  for (const char c : characters) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x30 || code > 0x6F) return std::nullopt;
    value = value << 6U | (code - 0x30U);
  }
  return value;
}

std::optional<std::string_view> AnswerStream::next() noexcept {
  const std::string_view text = wire::text_of(waiting());
  const std::size_t end = text.find("\n\n");
  if (end == std::string_view::npos) return std::nullopt;
  drop(end + 2);
  return text.substr(0, end);
}

bool decode_model(std::string_view answer, ScannerModel& model) noexcept {
  if (take_line(answer) != "PP" || checked(take_line(answer)) != "00") return false;
  // Millimetres, steps, turns a minute.
  std::array<Told, 7> told{{{"DMIN", 0, 10000, {}},
                            {"DMAX", 100, 262143, {}},
                            {"ARES", 16, 16384, {}},
                            {"AMIN", 0, 9999, {}},
                            {"AMAX", 0, 9999, {}},
                            {"AFRT", 0, 9999, {}},
                            {"SCAN", 60, 60000, {}}}};
  bool is_utm_30lx = false;
  while (!answer.empty()) {
    const std::string_view line = take_line(answer);
    if (!take_value(line, told)) return false;
    is_utm_30lx = is_utm_30lx || names_utm_30lx(line.substr(0, line.rfind(';')));
  }
  for (const Told& one : told)
    if (!one.value) return false;
  const auto value = [&told](std::size_t index) { return *told[index].value; };
  if (value(3) >= value(4) || value(4) - value(3) >= value(2)) return false;  // more than a turn
  model.range_min_m = static_cast<float>(value(0)) * 0.001F;
  model.range_max_m = static_cast<float>(value(1)) * 0.001F;
  model.steps_per_turn = value(2);
  model.first_step = value(3);
  model.last_step = value(4);
  model.front_step = value(5);
  model.period = duration_from_seconds(60.0 / static_cast<double>(value(6)));
  model.one_means_nothing = is_utm_30lx;
  return true;
}

Heard decode_scan(std::string_view answer, const ScannerModel& model, Time arrival, LaserScan& scan,
                  std::uint32_t& device_time_ms) noexcept {
  const std::string_view echo = take_line(answer);
  if (!is_scan_command(echo)) return Heard::kAnswer;
  const auto question = parse_question(echo, model);
  const auto status = checked(take_line(answer));
  if (!question || !status) return Heard::kMalformed;
  // "00" to M commands announces that scans will come; they, with status "99", and answers to G, "00", have more lines.
  if (*status != "00" && *status != "99") return Heard::kDeviceError;
  if (answer.empty()) return *status == "00" ? Heard::kAnswer : Heard::kMalformed;
  const auto stamp = checked(take_line(answer));
  const auto device_time = stamp ? decode_number(*stamp) : std::nullopt;
  if (!device_time || stamp->size() != 4) return Heard::kMalformed;
  if (!read_distances(answer, *question, model, scan)) return Heard::kMalformed;
  device_time_ms = *device_time;
  place(*question, model, arrival, scan);
  return Heard::kScan;
}

void ScipProtocol::begin() noexcept {
  step_ = Step::kDialect;
  asked_ = false;
  stream_.clear();
  device_clock_.forget();
  last_time_ms_.reset();
}

wire::Bytes ScipProtocol::to_say(Time) noexcept {
  if (asked_ || step_ == Step::kDone) return {};
  asked_ = true;
  write_command();
  return {reinterpret_cast<const std::uint8_t*>(command_.data()), said_.size() + 1};
}

void ScipProtocol::write_command() noexcept {
  int length = 0;
  if (step_ == Step::kScans) {
    const std::uint32_t steps = model_.last_step - model_.first_step + 1;
    const auto joined = static_cast<unsigned>((steps + kMaxBeams - 1) / kMaxBeams);
    // First step, last step, steps to a beam, no pauses, no end.
    length = std::snprintf(command_.data(), command_.size(), "MD%04u%04u%02u000\n",
                           static_cast<unsigned>(model_.first_step), static_cast<unsigned>(model_.last_step), joined);
  } else {
    constexpr std::array kFixed{"SCIP2.0", "QT", "PP", "BM"};
    length = std::snprintf(command_.data(), command_.size(), "%s\n", kFixed[static_cast<std::size_t>(step_)]);
  }
  said_ = {command_.data(), static_cast<std::size_t>(length - 1)};
}

Heard ScipProtocol::next(Time arrival, LaserScan& scan) noexcept {
  const auto answer = stream_.next();
  if (!answer) return Heard::kNothing;
  return step_ == Step::kDone ? on_scan(*answer, arrival, scan) : on_answer(*answer);
}

// Before all is said, scans that are still on their way from a former connection are passed over.
Heard ScipProtocol::on_answer(std::string_view answer) noexcept {
  std::string_view rest = answer;
  if (take_line(rest) != said_ || !asked_) return Heard::kAnswer;
  const std::string_view status = rest.substr(0, 2);  // without its checksum
  // "02" to BM: the laser is on already. A refused SCIP2.0: it speaks that already.
  const bool taken = step_ == Step::kDialect || status == "00" || (step_ == Step::kLaserOn && status == "02");
  const bool read = step_ != Step::kAsk || decode_model(answer, model_);
  if (!taken || !read) return Heard::kRefused;
  go_on();
  return Heard::kAnswer;
}

void ScipProtocol::go_on() noexcept {
  asked_ = false;
  step_ = static_cast<Step>(static_cast<int>(step_) + 1);
}

bool ScipProtocol::go_on_unanswered() noexcept {
  if (step_ != Step::kDialect) return false;
  go_on();
  return true;
}

// What stands before the last repetition of the command is what is left of an answer that was cut off.
Heard ScipProtocol::on_scan(std::string_view answer, Time arrival, LaserScan& scan) noexcept {
  const std::size_t begin = answer.rfind(said_);
  if (begin == std::string_view::npos) {
    skipped_ += answer.size();
    return Heard::kMalformed;
  }
  skipped_ += begin;
  std::uint32_t device_time_ms = 0;
  const Heard heard = decode_scan(answer.substr(begin), model_, arrival, scan, device_time_ms);
  if (heard == Heard::kScan) {
    count_lost(device_time_ms);
    scan.stamp -= device_clock_.delay(device_time_ms, arrival);
  }
  return heard;
}

// Scans are not numbered: one that is missing shows as two periods between two.
void ScipProtocol::count_lost(std::uint32_t device_time_ms) noexcept {
  const std::uint32_t between_ms = (device_time_ms - last_time_ms_.value_or(0)) % kClockTicks;
  const double periods = static_cast<double>(between_ms) * 1e-3 / to_seconds(model_.period);
  if (last_time_ms_ && periods > 1.5 && periods < kMostLost) lost_ += static_cast<std::uint64_t>(periods - 0.5);
  last_time_ms_ = device_time_ms;
}

}  // namespace jaywalk::scip
