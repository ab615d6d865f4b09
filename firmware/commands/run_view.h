#pragma once
#include <filesystem>
#include <string>

#include "firmware/commands/live_view.h"
#include "firmware/view/planner_tap.h"

namespace jaywalk {

/// The live page of a run on a robot: 25 ticks a second through a ring, goals and stops through the run's control
/// socket, like everybody's. Thread: the one that reports; no page delays a tick.
class RunView {
 public:
  /// Takes the memory. Prints the line `view: http://...`. Throws StartupError where the address cannot be served.
  RunView(const view::ViewAddress& where, std::filesystem::path control_socket, const std::string& title,
          const ControlSetup& setup, const EvidenceMap& map);

  [[nodiscard]] view::SnapshotTap& snapshots() noexcept { return snapshots_; }
  [[nodiscard]] view::PlannerTap& planner_tap() noexcept { return planner_tap_; }
  /// Shows what came since.
  void follow();

 private:
  [[nodiscard]] std::string obey(const view::ViewOrder& order) const;

  std::filesystem::path control_socket_;
  view::SnapshotTap snapshots_;
  view::PlannerTap planner_tap_;
  LiveView live_;
};

}  // namespace jaywalk
