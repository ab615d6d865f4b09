#pragma once
// Live page of a run: fed with its ticks, and of a simulation, at the pace of the wall clock.
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "apps/formats/ros_topics.h"
#include "apps/jaywalk/progress.h"
#include "apps/view/view_orders.h"
#include "apps/view/view_scene.h"
#include "apps/view/view_server.h"
#include "firmware/control_loop.h"
#include "firmware/safety/reasons.h"
#include "hal/sim/simulation.h"
#include "hal/types/geometry.h"

namespace jaywalk::view {

/// What of a tick the page's strip shows.
struct StripTick {
  double t_s = 0.0, wanted_mps = 0.0, permitted_mps = 0.0, speed_mps = 0.0;
  Vec2 at{};  ///< where the robot is, in the map
  Reason reasons = Reason::kNone;
};

/// Keeps frames in a file without a name, ticks from 0. Where the disk or kMostBytes is full, later ticks are not kept.
/// Any thread; not for a thread with a deadline.
class FrameStore {
 public:
  static constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 30U;

  /// The potential that frames from now on were made with; JSON.
  void add_field(std::string_view field) {
    const std::scoped_lock lock(mutex_);
    field_ = put(field);
  }
  /// What a scan or a plan changed, from now on; JSON.
  void add_scene(std::string_view scene) {
    const std::scoped_lock lock(mutex_);
    scene_ = put(scene);
  }
  /// The next tick; `head`: its frame_head().
  void add(const StripTick& strip, std::string_view head);

  /// {"kind":"then","frame":...,"field":...}; empty where that tick is not kept. `field` null where there is none.
  [[nodiscard]] std::string then(std::uint64_t tick) const;
  /// {"kind":"past","step":N,"ticks":[[t, wanted, permitted, speed, reasons, x, y], ...]}: every Nth, at most `most`.
  [[nodiscard]] std::string past(std::size_t most) const;

 private:
  struct Piece {
    std::uint64_t at = 0;
    std::uint32_t size = 0;
  };
  struct Entry {
    StripTick strip;
    Piece head, scene, field;
  };
  [[nodiscard]] Piece put(std::string_view text);
  [[nodiscard]] std::string read(const Piece& piece) const;

  mutable std::mutex mutex_;
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_{std::tmpfile(), &std::fclose};
  std::uint64_t size_ = 0;
  bool full_ = file_ == nullptr;
  Piece scene_, field_;
  std::vector<Entry> entries_;
};

}  // namespace jaywalk::view

namespace jaywalk {

/// The live page and its stream, fed with a run's ticks. What is slow (JSON, the store) happens in the thread that
/// calls; clients are served by a thread of their own. Thread: one, between ticks or beside the loop.
class LiveView {
 public:
  /// Takes an order, and tells the page what became of it; called on the server's thread, must not wait.
  using Obey = std::function<void(const view::ViewOrder&, view::Reply)>;

  /// `keeps_ticks`: any tick can be asked for, as long as the program runs. Prints the line `view: http://...`, with
  /// TLS its certificate's fingerprint too. Throws StartupError where the address cannot be served.
  LiveView(const view::ViewAddress& where, const ControlSetup& setup, bool keeps_ticks, Obey obey);

  /// Before the first tick.
  void begin(const view::HelloScene& hello);
  /// After each tick of a runner that this thread drives. `at_once`: whatever was shown just now.
  void follow(const LoopRunner& runner, const std::string& ended, bool at_once = false);

  /// Tells pages that a person wants no tick, from time to time: they tell that from a loop that hangs.
  void tell_paused() { server_->push(view::MessageKind::kFrame, R"({"kind":"paused"})"); }

  /// The same in pieces, for a loop with a thread of its own.
  void show(const view::ViewSnapshot& snapshot, const std::string& ended, bool at_once = false);
  void show(const view::FieldPicture& field);
  /// Shows nothing before it is due again.
  void show_map(const EvidenceMap& map, Time now) {
    if (topics_.is_map_due(now, server_->wanted())) topics_.add_map(map, now);
  }

  [[nodiscard]] std::string url() const { return server_->url(); }
  [[nodiscard]] int viewers() const noexcept { return server_->viewers(); }
  /// Whether a client is connected, or was some seconds ago: a page may be loaded anew.
  [[nodiscard]] bool is_watched();
  /// Whether a client subscribes to messages: these want every tick.
  [[nodiscard]] bool has_subscribers() const noexcept { return server_->wanted() != 0; }
  /// The run is over: goes on to serve what was kept until all viewers have been gone for some seconds, or for as long
  /// as `until_told`, or until an interruption.
  void stay(bool until_told, const Interruption& interruption);

 private:
  void answer(std::string_view text, const view::Reply& reply);
  void show_field_of(const LoopRunner& runner);

  Obey obey_;
  bool keeps_ticks_;
  view::FrameStore store_;
  ControlSetup setup_;
  view::ViewSnapshot snapshot_;
  std::string hello_, scene_;
  std::uint32_t scans_shown_ = 0, plan_shown_ = 0;  ///< TickRecord::scan_count(); the plan's sequence
  std::uint64_t tick_ = 0, field_ = 0;
  Time field_shown_ = kNever;
  std::chrono::steady_clock::time_point pushed_{}, seen_{};
  std::size_t joints_;  ///< channel
  std::unique_ptr<view::ViewServer> server_;
  exchange::RosTopics topics_;
  PlannedPath path_;  ///< of the newest plan
};

/// The live page of a simulation: shows its ticks at the pace of the wall clock, and passes on goals. All of it happens
/// between ticks; without an order from the page the run is the same, bit for bit. Thread: the simulation's.
class SimView {
 public:
  /// Prints and throws as LiveView does.
  SimView(const view::ViewAddress& where, const ControlSetup& setup, OperatorPanel& panel);

  [[nodiscard]] OperatorPanel& panel() noexcept { return panel_; }
  /// `played`: the simulation that the page's orders may change (jaywalk sim --endless); null: none.
  void begin(const std::string& title, std::span<const sim::WallSegment> walls, sim::Simulation* played);
  /// After a tick: shows it, waits for the wall clock, and while the page has paused the run. `ended`: the outcome.
  void follow(const LoopRunner& runner, const std::string& ended, const Interruption& interruption);
  /// Whether a client that may give the next goal is connected.
  [[nodiscard]] bool is_watched() { return takes_goals_ && live_.is_watched(); }
  /// After the run: see LiveView::stay.
  void stay(const Interruption& interruption) { live_.stay(false, interruption); }

 private:
  /// Thread: the server's.
  void take(const view::ViewOrder& order, const view::Reply& reply);
  void play(const view::ViewOrder& order);
  void keep_pace(Duration tick);
  void obey_while_paused(const Interruption& interruption);

  view::ViewOrders orders_;
  view::SteeredPanel panel_;
  bool takes_goals_;
  std::chrono::steady_clock::time_point due_ = std::chrono::steady_clock::now();
  bool paused_ = false;
  sim::Simulation* played_ = nullptr;
  double pace_ = 1.0;                                   ///< simulated seconds a second
  std::atomic<bool> stands_{true}, is_stopped_{false};  ///< at rest; by the page's Stop
  LiveView live_;
};

}  // namespace jaywalk
