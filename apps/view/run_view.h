#pragma once
#include <atomic>
#include <boost/asio/thread_pool.hpp>
#include <filesystem>
#include <string>

#include "apps/report/run_observer.h"
#include "apps/view/live_view.h"
#include "apps/view/secret.h"
#include "apps/view/view_scene.h"

namespace jaywalk {
/// The live page of a run on a robot: 25 ticks a second through a ring, goals, stops and resets through the run's
/// control socket, as those of any client; and what a run leaves in its folder. No page delays a tick. To look and to
/// set goals wants a token, on this machine too: the socket is not everybody's either. The address with the token lies
/// beside it.
class RunView final : public RunObserver {
 public:
  /// Takes the memory. Prints the line `view: http://...`. Throws StartupError where the address cannot be served.
  RunView(const view::ViewAddress& where, const std::filesystem::path& control_socket, const std::string& title,
          const ControlSetup& setup, const EvidenceMap& map);

  void after_tick(const TickRecord& record, const ControlLoop& loop) noexcept override {
    tap_.after_tick(record, loop);
  }
  void after_plan(const Planner& planner, const EvidenceMap& map, Time stamp) noexcept override {
    tap_.after_plan(planner, map, stamp);
  }
  /// Shows what came since.
  void follow() override;
  /// Tells the page first: the end takes seconds.
  std::filesystem::path finish(const RunEnd& end, const ControlLoop& loop, const Planner& planner) override;

 private:
  void obey(const view::ViewOrder& order, const view::Reply& reply);
  std::string said_to(const std::string& line) const;
  void stop(const view::Reply& reply);
  void go(const std::string& line, const view::Reply& reply);

  std::string control_socket_;
  view::RunTap tap_;
  view::ViewSnapshot last_;  ///< shown
  std::atomic<unsigned> stops_asked_{0}, stops_done_{0}, goals_waiting_{0};
  // The socket may take seconds to answer. They outlive the server, which calls; the goals outlive the stops, which
  // pass them on.
  boost::asio::thread_pool goals_{1}, stops_{1};
  LiveView live_;
  view::AddressFile address_file_;
};

}  // namespace jaywalk
