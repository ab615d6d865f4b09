#include "drivers/laser/scanner_connection.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>

#include "drivers/laser/scip.h"
#include "drivers/laser/serial_scanners.h"
#include "drivers/laser/sick.h"
#include "drivers/ros/ros_scan.h"
#include "drivers/wire/thread_without_signals.h"
#include "hal/types/errors.h"

namespace jaywalk {
namespace {

/// So long at most until limits are looked at again, and until the thread sees that it is to end.
constexpr Duration kLongestWait = std::chrono::milliseconds(20);
/// 64 kB a step: a scanner sends less than that in 20 ms, and a flood does not keep the limits from being looked at.
constexpr int kMostReads = 16;

constexpr Duration kConnectLimit = std::chrono::seconds(2), kScannerAnswer = std::chrono::seconds(1);
/// Without a scan for so long, the connection is given up.
constexpr Duration kScanSilence = std::chrono::seconds(1);
/// A scan is late when its stamp is this much older than its sweep.
constexpr Duration kScanLate = std::chrono::milliseconds(500);

// In the order of ScannerKind.
constexpr std::array<ScannerMake, 7> kKinds{{{"sick-cola-a", ScannerKind::kSickColaA, 2112, 0},
                                             {"sick-cola-b", ScannerKind::kSickColaB, 2112, 0},
                                             {"hokuyo", ScannerKind::kHokuyo, 10940, 115200},
                                             {"ld19", ScannerKind::kLdrobot, 0, 230400},
                                             {"lms200", ScannerKind::kLms200, 0, 9600},
                                             {"rplidar", ScannerKind::kRplidar, 0, 115200},
                                             {"dds", ScannerKind::kDds, 0, 0}}};

std::unique_ptr<wire::Link> link_of(const ScannerSetup& setup, const ScannerMake& kind, std::uint32_t baud) {
  if (setup.kind == ScannerKind::kDds) return std::make_unique<ros::RingLink>(setup.device, setup.topic);
  const bool on_network = !setup.host.empty();
  if (on_network == !setup.device.empty()) {
    throw StartupError("scanner: " + std::string(on_network ? "both host and device" : "neither host nor device"),
                       "give the host of one on a network, or the device of one on a serial line");
  }
  if (on_network && kind.port == 0)
    throw StartupError(setup.host + ": " + std::string(kind.name) + " is not on a network", "give its serial device");
  if (!on_network && kind.baud == 0)
    throw StartupError(setup.device + ": " + std::string(kind.name) + " is not on a serial line", "give its host");
  return wire::make_byte_link(setup.host, setup.port == 0 ? kind.port : setup.port, setup.device, baud);
}

std::unique_ptr<ScannerProtocol> protocol_of(const ScannerSetup& setup, std::uint32_t baud) {
  const sick::ScannerModel model{.range_min_m = setup.range_min_m, .range_max_m = setup.range_max_m};
  switch (setup.kind) {
    case ScannerKind::kSickColaA: return std::make_unique<sick::SickProtocol>(sick::Cola::kA, model);
    case ScannerKind::kSickColaB: return std::make_unique<sick::SickProtocol>(sick::Cola::kB, model);
    case ScannerKind::kHokuyo: return std::make_unique<scip::ScipProtocol>();
    case ScannerKind::kLdrobot: return std::make_unique<ldrobot::LdProtocol>();
    case ScannerKind::kLms200: return std::make_unique<lms200::Lms200Protocol>(baud);
    case ScannerKind::kRplidar: return std::make_unique<rplidar::RplidarProtocol>();
    case ScannerKind::kDds: return std::make_unique<ros::RosScanProtocol>(setup.infinity_is_free);
  }
  throw StartupError("scanner: of no known kind", "choose one of those in drivers/laser/scanner_connection.h");
}

}  // namespace

std::string_view name(ScannerTrouble trouble) noexcept {
  constexpr std::array<std::string_view, 9> kNames{
      "none",           "scanner unreachable",      "scanner closed the connection",
      "no answer",      "scanner refuses to send",  "scanner silent",
      "scans are late", "scanner reports an error", "scanner's window is dirty"};
  const auto index = static_cast<std::size_t>(trouble);
  return index < kNames.size() ? kNames[index] : "unknown trouble";
}

ScannerConnection::~ScannerConnection() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
}

bool ScannerConnection::start(int priority) {
  thread_ = thread_without_signals("laser", [this] {
    for (; !stopping_; link_->wait(kLongestWait)) step();
  });
  const sched_param wanted{.sched_priority = priority};
  const int policy = priority > 0 ? SCHED_FIFO : SCHED_OTHER;
  return ::pthread_setschedparam(thread_.native_handle(), policy, &wanted) == 0;
}

void ScannerConnection::step() noexcept {
  const Time now = clock_.now();
  if (phase_ == Phase::kResting && now >= rest_until_) {
    link_->open();
    opened_ = now;
    phase_ = Phase::kOpening;
  }
  if (phase_ == Phase::kOpening) await_opening(now);
  if (phase_ == Phase::kTalking) talk(now);
  tell_health();
}

void ScannerConnection::await_opening(Time now) noexcept {
  const wire::Link::State state = link_->state();
  const bool opens = state == wire::Link::State::kOpening;
  if (state == wire::Link::State::kClosed || (opens && age(opened_, now) > kConnectLimit))
    return give_up(ScannerTrouble::kUnreachable, now);
  if (opens) return;
  protocol_->begin();
  progress_ = now;
  scan_late_ = false;
  ++health_.connections;
  phase_ = Phase::kTalking;
}

void ScannerConnection::talk(Time now) noexcept {
  for (int k = 0; k < kMostReads && phase_ == Phase::kTalking; ++k) {
    const wire::Bytes bytes = link_->read(room_);
    if (bytes.empty()) break;
    protocol_->hear(bytes);
    take_messages(clock_.now());
  }
  if (phase_ != Phase::kTalking) return;
  link_->write(protocol_->to_say(now));
  if (link_->state() == wire::Link::State::kClosed) return give_up(ScannerTrouble::kClosed, now);
  watch(now);
}

void ScannerConnection::take_messages(Time arrival) noexcept {
  for (;;) {
    const bool asked = protocol_->awaits_answer();
    switch (protocol_->next(arrival, scans_.draft())) {
      case Heard::kNothing: return;
      case Heard::kScan: take_scan(arrival); break;
      case Heard::kAnswer:
        if (asked && !protocol_->awaits_answer()) progress_ = arrival;
        break;
      case Heard::kMalformed: ++health_.malformed; break;
      case Heard::kDeviceError: suffer(ScannerTrouble::kDeviceError); break;
      case Heard::kDirty: suffer(ScannerTrouble::kDirty); break;
      case Heard::kRefused: return give_up(ScannerTrouble::kRefused, arrival);
    }
  }
}

void ScannerConnection::take_scan(Time arrival) noexcept {
  LaserScan& scan = scans_.draft();
  scan_late_ = age(scan.stamp, arrival) > scan.sweep + kScanLate;
  const bool newer = scan.stamp > last_stamp_;  // two that came at once on a new connection may look simultaneous
  if (scan_late_ || !newer) ++health_.late;
  if (newer) {
    last_stamp_ = scan.stamp;
    scan.sequence = ++sequence_;
    ++health_.scans;
    scans_.publish();
  }
  if (scan_late_) return;
  progress_ = arrival;
  rest_ = kFirstRest;
  health_.trouble = ScannerTrouble::kNone;
}

void ScannerConnection::watch(Time now) noexcept {
  const Duration without = age(progress_, now);
  if (protocol_->awaits_answer() && without > kScannerAnswer) {
    if (!protocol_->go_on_unanswered()) return give_up(ScannerTrouble::kNoAnswer, now);
    progress_ = now;
    return;
  }
  if (without <= kScanSilence) return;
  const bool says_why = health_.trouble == ScannerTrouble::kDeviceError || health_.trouble == ScannerTrouble::kDirty;
  give_up(says_why ? health_.trouble : scan_late_ ? ScannerTrouble::kLate : ScannerTrouble::kSilent, now);
}

void ScannerConnection::give_up(ScannerTrouble why, Time now) noexcept {
  link_->close();
  suffer(why);
  phase_ = Phase::kResting;
  rest_until_ = now + rest_;
  rest_ = std::min(2 * rest_, kLongestRest);
}

void ScannerConnection::tell_health() noexcept {
  health_.protocol = protocol_->counts();
  if (health_ == told_) return;
  told_ = health_;
  healths_.publish(health_);
}

std::span<const ScannerMake> scanner_makes() noexcept { return kKinds; }

const ScannerMake& scanner_make(ScannerKind kind) noexcept { return kKinds[static_cast<std::size_t>(kind)]; }

std::optional<ScannerKind> scanner_kind(std::string_view name) noexcept {
  const auto* const found = std::ranges::find(kKinds, name, &ScannerMake::name);
  return found == kKinds.end() ? std::nullopt : std::optional(found->kind);
}

std::unique_ptr<ScannerConnection> make_scanner(const ScannerSetup& setup, Clock& clock) {
  const ScannerMake& kind = scanner_make(setup.kind);
  const std::uint32_t baud = setup.baud == 0 ? kind.baud : setup.baud;
  return std::make_unique<ScannerConnection>(link_of(setup, kind, baud), protocol_of(setup, baud), clock);
}

}  // namespace jaywalk
