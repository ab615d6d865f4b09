#include "drivers/laser/scip_protocol.h"

#include <algorithm>
#include <cstdio>

namespace jaywalk::scip {
namespace {

/// More scans than this do not go missing on a connection that lives: the scanner began to count anew.
constexpr std::uint32_t kMostLost = 1000;

/// An answer's status without its checksum: what stands between the first and the second line's end.
std::string_view status_of(std::string_view answer) noexcept {
  const std::size_t begin = std::min(answer.find('\n'), answer.size() - 1) + 1;
  return answer.substr(begin, 2);
}

}  // namespace

void ScipProtocol::begin() noexcept {
  step_ = Step::kDialect;
  asked_ = false;
  stream_.forget();
  device_clock_.forget();
  has_time_ = false;
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
  const bool of_this = asked_ && answer.substr(0, answer.find('\n')) == said_;
  if (!of_this) return Heard::kAnswer;
  const std::string_view status = status_of(answer);
  // "02" to BM: the laser is on already. A refused SCIP2.0: it speaks that already.
  const bool taken = step_ == Step::kDialect || status == "00" || (step_ == Step::kLaserOn && status == "02");
  const bool read = step_ != Step::kAsk || decode_model(answer, model_) == Decoding::kScan;
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
  const Heard heard = heard_of(decode_scan(answer.substr(begin), model_, arrival, scan, device_time_ms));
  if (heard == Heard::kScan) {
    count_lost(device_time_ms);
    scan.stamp -= device_clock_.delay(device_time_ms, arrival);
  }
  return heard;
}

// Scans are not numbered: one that is missing shows as two periods between two.
void ScipProtocol::count_lost(std::uint32_t device_time_ms) noexcept {
  const std::uint32_t between_ms = (device_time_ms - last_time_ms_) % kClockTicks;
  const double periods = static_cast<double>(between_ms) * 1e-3 / to_seconds(model_.period);
  if (has_time_ && periods > 1.5 && periods < kMostLost) lost_ += static_cast<std::uint64_t>(periods - 0.5);
  has_time_ = true;
  last_time_ms_ = device_time_ms;
}

}  // namespace jaywalk::scip
