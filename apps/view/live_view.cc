#include "apps/view/live_view.h"

#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

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

namespace jaywalk {
namespace {
constexpr auto kPushEvery = std::chrono::milliseconds(40);        // smooth to the eye
constexpr Duration kFieldEvery = std::chrono::milliseconds(500);  // 22 kB, and it changes slowly
constexpr auto kGone = std::chrono::seconds(3);                   // a page that is loaded anew is back before
constexpr auto kLookEvery = std::chrono::milliseconds(50);
constexpr std::size_t kMostStripTicks = 2000;  // more than a screen has columns

std::vector<view::FoxgloveChannel> channels_of(const RobotModel& model) {
  std::vector<view::FoxgloveChannel> all;
  for (const auto& [name, type] : exchange::topics_of(model)) all.push_back({name, type, exchange::ros_schema(type)});
  all.push_back(view::joint_channel());
  return all;
}

std::vector<view::FoxgloveParameter> parameters_of(const ControlSetup& setup) {
  const RobotModel& model = setup.model;
  return {{"/jaywalk.rate_hz", setup.rate_hz},
          {"/jaywalk.max_speed_mps", model.limits.max_speed_mps},
          {"/jaywalk.brake_mps2", model.limits.brake_mps2},
          {"/jaywalk.track_width_m", model.drive.track_width_m},
          {"/jaywalk.wheel_radius_m", model.drive.wheel_radius_m},
          {"/jaywalk.front_m", model.footprint.front_m},
          {"/jaywalk.rear_m", model.footprint.rear_m},
          {"/jaywalk.half_width_m", model.footprint.half_width_m}};
}

constexpr auto kPausedLook = std::chrono::milliseconds(5);  // at the page's orders while paused
constexpr int kLooksUntilTold = 20;
constexpr double kFaultLasts_s = 5.0;  // that a person begins

/// In FaultKind's order.
std::span<const std::string> played_faults() { return sim::scenario_keys().find("faults", "kind").choices; }

}  // namespace

LiveView::LiveView(const view::ViewAddress& where, const ControlSetup& setup, bool keeps_ticks, Obey obey)
    : obey_(std::move(obey)),
      keeps_ticks_(keeps_ticks),
      setup_(setup),
      joints_(exchange::topics_of(setup.model).size()),
      server_(view::ViewServer::serve(
          where, {.on_order = [this](std::string_view text, const view::Reply& reply) { answer(text, reply); },
                  .channels = channels_of(setup.model),
                  .parameters = parameters_of(setup)})),
      topics_([this](std::size_t channel, Time stamp, std::string message) {
        server_->push(view::MessageKind::kTopic, std::move(message), stamp, channel);
      }) {
  std::printf("view: %s\n", server_->url().c_str());
  if (!server_->fingerprint().empty()) std::printf("its certificate, SHA-256: %s\n", server_->fingerprint().c_str());
  std::fflush(stdout);
}

/// {"tick":N}, {"past":true}, or an order.
void LiveView::answer(std::string_view text, const view::Reply& reply) {
  if (const auto order = view::parse_order(text)) {
    return obey_(*order, [reply](const std::string& said) {
      reply(said.empty() ? "" : nlohmann::json{{"kind", "said"}, {"text", said}}.dump());
    });
  }
  const auto asked = nlohmann::json::parse(text, nullptr, false);
  if (!keeps_ticks_ || !asked.is_object()) return;
  if (asked.contains("past")) return reply(store_.past(kMostStripTicks));
  if (asked.contains("tick") && asked["tick"].is_number_unsigned())
    reply(store_.then(asked["tick"].get<std::uint64_t>()));
}

void LiveView::begin(const view::HelloScene& hello) {
  hello_ = to_json(hello, setup_, keeps_ticks_);
  server_->push(view::MessageKind::kHello, hello_);
}

void LiveView::follow(const LoopRunner& runner, const std::string& ended, bool at_once) {
  take(snapshot_, runner.last(), runner.loop());
  show_field_of(runner);
  show(snapshot_, ended, at_once);
  show_map(runner.loop().tracker().still(), runner.last().now);
}

void LiveView::show_field_of(const LoopRunner& runner) {
  const Time now = runner.last().now;
  if (field_shown_ != kNever && age(field_shown_, now) < kFieldEvery) return;
  if (runner.loop().plan().status != PlanStatus::kOk) return;
  field_shown_ = now;
  const auto picture = std::make_unique<view::FieldPicture>();
  draw(*picture, runner.planner().view_field(), runner.loop().tracker().still());
  show(*picture);
}

void LiveView::show(const view::FieldPicture& field) {
  std::string text = to_json(field, field_++);
  if (keeps_ticks_) store_.add_field(text);
  server_->push(view::MessageKind::kField, std::move(text));
}

void LiveView::show(const view::ViewSnapshot& snapshot, const std::string& ended, bool at_once) {
  const TickRecord& t = snapshot.record;
  if (path_.stamp != snapshot.plan.stamp) keep_path(snapshot.plan, path_);
  const std::uint32_t wanted = server_->wanted();
  if (wanted != 0) server_->push(view::MessageKind::kTime, "", t.now);
  topics_.add(t, {snapshot.tracks.begin(), snapshot.tracks.size()}, path_, setup_.model, wanted);
  if ((wanted >> joints_ & 1U) != 0 && t.wheels.sequence != 0)
    server_->push(view::MessageKind::kTopic, view::joint_states(t.wheels, t.now), t.now, joints_);
  const auto now = std::chrono::steady_clock::now();
  const bool is_due = server_->has_pages() && (at_once || !ended.empty() || now - pushed_ >= kPushEvery);
  if (!keeps_ticks_ && !is_due) return static_cast<void>(++tick_);
  const bool changed = t.scan_count() != scans_shown_ || snapshot.plan.sequence != plan_shown_ || scene_.empty();
  if (changed) {
    scene_ = to_json(snapshot, setup_.model.lasers());
    scans_shown_ = t.scan_count();
    plan_shown_ = snapshot.plan.sequence;
    if (keeps_ticks_) store_.add_scene(scene_);
  }
  const std::string head = view::frame_head(snapshot, tick_++, setup_, ended);
  if (keeps_ticks_) {
    store_.add({.t_s = to_seconds(t.now),
                .wanted_mps = t.wanted.v_mps,
                .permitted_mps = t.verdict.permitted.v_mps,
                .speed_mps = snapshot.twist.v_mps,
                .at = t.pose.map_from_robot.position(),
                .reasons = t.verdict.reasons},
               head);
  }
  if (!is_due) return;
  pushed_ = now;
  server_->push(ended.empty() ? view::MessageKind::kFrame : view::MessageKind::kEnd, head + scene_ + "}");
}

bool LiveView::is_watched() {
  const auto now = std::chrono::steady_clock::now();
  if (viewers() > 0) seen_ = now;
  return now - seen_ <= kGone;
}

void LiveView::stay(bool until_told, const Interruption& interruption) {
  if (!until_told && !is_watched()) return;
  std::fprintf(stderr, "jaywalk: the run is over; its page stays until %sCtrl-C\n",
               until_told ? "" : "it is closed, or ");
  server_->push(view::MessageKind::kHello, hello_.substr(0, hello_.size() - 1) + R"(,"over":true})");
  while (!interruption.came() && (until_told || is_watched())) std::this_thread::sleep_for(kLookEvery);
}

SimView::SimView(const view::ViewAddress& where, const ControlSetup& setup, OperatorPanel& panel)
    : panel_(panel),
      takes_goals_(!setup.keeps_speed()),
      live_(where, setup, true,
            [this](const view::ViewOrder& order, const view::Reply& reply) { take(order, reply); }) {}

void SimView::take(const view::ViewOrder& order, const view::Reply& reply) {
  orders_.add(order);
  if (order.stop) reply(takes_goals_ ? "stopping\n" : "refused: a run that keeps its speed does not stop\n");
  if (order.reset) reply(stands_ ? "reset\n" : "refused: the robot still moves; try again when it stands\n");
  if (order.here) reply("refused: a simulated robot stands where it is\n");
  if (order.plays() && played_ == nullptr) reply("refused: start the simulation with --endless\n");
  if (order.goal && is_stopped_) reply("refused: stopped by this page; press Reset first\n");
}

void SimView::begin(const std::string& title, std::span<const sim::WallSegment> walls, sim::Simulation* played) {
  played_ = played;
  const std::span<const std::string> faults = played == nullptr ? std::span<const std::string>() : played_faults();
  live_.begin({.title = title, .walls = walls, .takes_goals = takes_goals_, .faults = faults});
}

void SimView::play(const view::ViewOrder& order) {
  if (played_ == nullptr) return;
  if (order.pace) pace_ = *order.pace;
  if (order.fault && *order.fault < played_faults().size())
    played_->begin_fault(static_cast<sim::FaultKind>(*order.fault), kFaultLasts_s);
  for (int k = 0; k < std::abs(order.walkers); ++k)
    if (!(order.walkers > 0 ? played_->add_walker() : played_->remove_walker())) return;
}

void SimView::follow(const LoopRunner& runner, const std::string& ended, const Interruption& interruption) {
  live_.follow(runner, ended, paused_);
  stands_ = runner.last().verdict.permitted == Twist2{};
  keep_pace(runner.setup().tick());
  if (ended.empty()) obey_while_paused(interruption);
}

/// A run that was held up does not hurry to make up for it.
void SimView::keep_pace(Duration tick) {
  const auto now = std::chrono::steady_clock::now();
  const Duration wait = duration_from_seconds(to_seconds(tick) / pace_);
  due_ = std::max(due_ + std::chrono::duration_cast<std::chrono::steady_clock::duration>(wait), now);
  std::this_thread::sleep_until(due_);
}

void SimView::obey_while_paused(const Interruption& interruption) {
  for (int looks = 0; !interruption.came(); ++looks, std::this_thread::sleep_for(kPausedLook)) {
    const view::ViewOrder order = orders_.take();
    if (order.pause) paused_ = *order.pause;
    play(order);
    if (takes_goals_) panel_.obey(order, stands_);
    is_stopped_ = panel_.is_pressed();
    if (!paused_ || order.step) return;
    if (looks % kLooksUntilTold == 0) live_.tell_paused();
  }
}

}  // namespace jaywalk
