#pragma once
#include <atomic>
#include <chrono>
#include <string>

#include "apps/view/live_view.h"
#include "apps/view/steered_panel.h"

namespace jaywalk {

/// The live page of a simulation: shows its ticks at the pace of the wall clock, and passes on goals. All of it happens
/// between ticks; without an order from the page the run is the same, bit for bit. Thread: the simulation's.
class SimView {
 public:
  /// Prints the line `view: http://...`. Throws StartupError where the address cannot be served.
  SimView(const view::ViewAddress& where, const ControlSetup& setup, OperatorPanel& panel);

  [[nodiscard]] OperatorPanel& panel() noexcept { return panel_; }
  void begin(const std::string& title, std::span<const view::WallPiece> walls);
  /// After a tick: shows it, waits for the wall clock, and while the page has paused the run. `ended`: the outcome.
  void follow(const LoopRunner& runner, const std::string& ended, const Interruption& interruption);
  /// Whether a client that may give the next goal is connected.
  [[nodiscard]] bool is_watched() { return takes_goals_ && live_.is_watched(); }
  /// After the run: see LiveView::stay.
  void stay(const Interruption& interruption) { live_.stay(false, interruption); }

 private:
  /// Thread: the page's.
  void take(const view::ViewOrder& order, const view::Reply& reply);
  void keep_pace();
  void obey_while_paused(const Interruption& interruption);

  view::ViewOrders orders_;
  view::SteeredPanel panel_;
  bool takes_goals_;
  Duration tick_;
  std::chrono::steady_clock::time_point due_ = std::chrono::steady_clock::now();
  bool paused_ = false;
  std::atomic<bool> stands_{true}, is_stopped_{false};  ///< at rest; by the page's Stop
  LiveView live_;
};

}  // namespace jaywalk
