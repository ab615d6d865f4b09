#include "apps/setup/armed_session.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <iostream>

#include "hal/types/errors.h"

namespace jaywalk {
namespace {

std::atomic<bool> to_stop{false};

void require_consent(bool yes, const std::string& name, const std::string& motion) {
  if (yes) return;
  if (::isatty(STDIN_FILENO) == 0)
    throw StartupError(name + ": the wheels will turn, and nobody is there to be asked",
                       "give --yes where the answer is yes: " + motion);
  std::fprintf(stderr, "%s [yes/no] ", motion.c_str());
  std::string answer;
  std::getline(std::cin, answer);
  if (answer != "yes") throw StartupError(name + ": not confirmed", "answer yes, or give --yes");
}

std::string obey(std::string_view line) {
  if (line != "stop" && line != "stop now") return "refused: the wheels are being turned; it knows stop\n";
  to_stop = true;
  return "stopping\n";
}

/// What the kernel does not permit of what this thread and its process wish.
std::vector<std::string> enter_fully(const RealtimeWishes& wishes) {
  std::vector<std::string> refused;
  if (wishes.lock_memory) refused = lock_memory();
  for (std::string& line : enter_realtime(wishes)) refused.push_back(std::move(line));
  return refused;
}

}  // namespace

ArmedSession::ArmedSession(const SessionOptions& options, const std::string& name, const std::string& motion)
    : file_(load_robot_file(options.robot)) {
  if (options.allow_no_realtime) file_.realtime.required = false;
  require_consent(options.yes, name, motion);
  const std::filesystem::path of_file = file_.control_socket.empty() ? default_control_socket() : file_.control_socket;
  socket_ = std::make_unique<ControlSocket>(options.control_socket.empty() ? of_file : options.control_socket, obey);
  ::signal(SIGINT, [](int) { to_stop = true; });
  ::signal(SIGTERM, [](int) { to_stop = true; });
  devices_ = std::make_unique<RobotDevices>(file_, clock_);
  devices_->start();
  for (const auto& laser : devices_->lasers()) lasers_.push_back(laser.get());
  require_realtime(file_.realtime, enter_fully(file_.realtime));  // before the drives may turn a wheel
  static_cast<void>(devices_->drive().arm());
}

ArmedSession::~ArmedSession() {
  const Time limit = clock_.now() + std::chrono::milliseconds(500);
  do {
    static_cast<void>(devices_->drive().latest());
    devices_->drive().disarm();
    clock_.sleep_until(clock_.now() + std::chrono::milliseconds(10));
  } while (devices_->drive().is_enabled() && clock_.now() < limit);
}

bool ArmedSession::stopped() { return to_stop; }

}  // namespace jaywalk
