#pragma once
// The local socket through which a person, or a program, talks to a run: one line there, an answer back, the end.
//
//   goto X Y      the goal, m in the map         stop          no goal: the robot ramps to rest
//   goto X Y H    and its heading there, rad     stop now      emergency stop, latched
//   status        how it goes                    reset         after a latched fault, at rest
//   here X Y H    where it is, at rest
#include <sys/types.h>

#include <atomic>
#include <filesystem>
#include <string>
#include <thread>

#include "drivers/wire/file_descriptor.h"
#include "firmware/robot/control_clients.h"

namespace jaywalk {

/// $JAYWALK_SOCKET, else jaywalk.sock in $XDG_RUNTIME_DIR, else in the folder for temporary files.
[[nodiscard]] std::filesystem::path default_control_socket();

/// Listens in a thread of its own and serves all clients there, a round of them every 5 ms at most: a flood of clients
/// takes a bounded share of a processor, and a stop is read within two rounds (SAFETY: within 100 ms). Owner and group
/// may talk.
class ControlSocket {
 public:
  using Answer = ControlClients::Answer;

  /// `priority`: the thread's, of SCHED_FIFO; 0: an ordinary one. Throws StartupError where another run listens there,
  /// or nobody can.
  ControlSocket(std::filesystem::path path, Answer answer, int priority = 0);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

 private:
  void serve(int priority) noexcept;

  std::filesystem::path path_;
  ControlClients clients_;
  wire::FileDescriptor listener_;
  ino_t inode_;  ///< the socket's
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

/// Says a line to the run that listens at `path` and returns its answer. Throws StartupError where none does.
[[nodiscard]] std::string ask(const std::filesystem::path& path, const std::string& line);

}  // namespace jaywalk
