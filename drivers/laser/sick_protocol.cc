#include "drivers/laser/sick_protocol.h"

namespace jaywalk::sick {

namespace {

using namespace std::string_view_literals;

// "client", hashed as the scanner wants it; level 3 is the authorised client.
constexpr std::array<std::string_view, 4> kWords{"SetAccessMode", "LMDscandatacfg", "Run", "LMDscandata"};
// Channel 1, no remission, 16 bits, unit 0, no encoder, no position, no name, no comment, no time, every scan.
constexpr std::array<std::string_view, 4> kInText{"sMN SetAccessMode 03 F4724744"sv,
                                                  "sWN LMDscandatacfg 01 00 0 1 0 00 00 0 0 0 0 +1"sv, "sMN Run"sv,
                                                  "sEN LMDscandata 1"sv};
constexpr std::array<std::string_view, 4> kInBinary{
    "sMN SetAccessMode \x03\xF4\x72\x47\x44"sv,
    "sWN LMDscandatacfg \x01\x00\x00\x01\x00\x00\x00\x00\x00\x00\x00\x00\x01"sv, "sMN Run"sv, "sEN LMDscandata \x01"sv};
/// More telegrams than this do not go missing on a connection that lives: the scanner began to count anew.
constexpr std::uint16_t kMostLost = 1000;

}  // namespace

SickProtocol::SickProtocol(Cola dialect, const ScannerModel& model) noexcept
    : dialect_(dialect), model_(model), stream_(dialect) {
  speak(dialect);
}

void SickProtocol::speak(Cola dialect) noexcept {
  dialect_ = dialect;
  const auto& commands = dialect == Cola::kA ? kInText : kInBinary;
  for (std::size_t k = 0; k < steps_.size(); ++k) steps_[k] = {framed(dialect, commands[k]), kWords[k]};
  stream_.begin(dialect);
}

void SickProtocol::begin() noexcept {
  at_ = 0;
  asked_ = false;
  speak(tried_ && !understood_ ? other(dialect_) : dialect_);
  tried_ = true;
  device_clock_.forget();
  has_counter_ = false;
}

wire::Bytes SickProtocol::to_say(Time) noexcept {
  if (asked_ || at_ == steps_.size()) return {};
  asked_ = true;
  return {steps_[at_].command.data(), steps_[at_].command.size()};
}

Heard SickProtocol::next(Time arrival, LaserScan& scan) noexcept {
  const auto body = stream_.next();
  if (!body) return Heard::kNothing;
  understood_ = true;
  ScanHeader header;
  const Heard heard = heard_of(decode_scan(dialect_, *body, model_, arrival, scan, header));
  if (heard == Heard::kAnswer) return on_answer(text_of(*body));
  if (heard == Heard::kScan) {
    count_lost(header.telegram_counter);
    if (header.warns_of_dirt) ++warned_;
    scan.stamp -= device_clock_.delay(header.sent_time_us, arrival);
  }
  return heard;
}

// "sAN Run 1", "sWA LMDscandatacfg", "sEA LMDscandata 1", or "sFA" and a number for any command that is refused.
Heard SickProtocol::on_answer(std::string_view body) noexcept {
  if (!asked_ || body.size() < 3) return Heard::kAnswer;
  bool taken = false;
  if (body.substr(0, 3) != "sFA") {
    const std::string_view rest = body.substr(std::min<std::size_t>(4, body.size()));
    const std::string_view word = rest.substr(0, rest.find(' '));
    if (word != steps_[at_].word) return Heard::kAnswer;
    const char last = rest.back();
    taken = word.size() == rest.size() || last == '1' || last == '\x01';
  }
  return conclude(taken) ? Heard::kAnswer : Heard::kRefused;
}

bool SickProtocol::go_on_unanswered() noexcept { return conclude(false); }

bool SickProtocol::conclude(bool taken) noexcept {
  const bool must = at_ + 1 == steps_.size();
  if (!taken && must) return false;
  asked_ = false;
  ++at_;
  if (!taken) ++refused_;
  return true;
}

void SickProtocol::count_lost(std::uint16_t telegram_counter) noexcept {
  const auto missing = static_cast<std::uint16_t>(telegram_counter - last_counter_ - 1);
  if (has_counter_ && missing <= kMostLost) lost_ += missing;
  has_counter_ = true;
  last_counter_ = telegram_counter;
}

ProtocolCounts SickProtocol::counts() const noexcept { return {lost_, stream_.skipped(), refused_, warned_}; }

}  // namespace jaywalk::sick
