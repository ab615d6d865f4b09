#pragma once
// The local socket through which a person, or a program, talks to a run: one line there, an answer back, the end.
//
//   goto X Y      the goal, m in the map         stop          no goal: the robot ramps to rest
//   goto X Y H    and its heading there, rad     stop now      emergency stop, latched
//   status        how it goes                    reset         after a latched fault, at rest
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

#include "drivers/wire/file_descriptor.h"

namespace jaywalk {

/// $JAYWALK_SOCKET, else jaywalk.sock in $XDG_RUNTIME_DIR, else in the folder for temporary files.
[[nodiscard]] std::filesystem::path default_control_socket();

/// Listens in a thread of its own; one talk at a time, each given a second at most. Owner and group may talk.
class ControlSocket {
 public:
  /// Answers a line; called in the socket's thread. What begins with "refused" tells the asker that it failed.
  using Answer = std::function<std::string(std::string_view line)>;
  static constexpr std::size_t kLongestLine = 200;

  /// Throws StartupError where another run listens there, or nobody can.
  ControlSocket(std::filesystem::path path, Answer answer);
  ~ControlSocket();
  ControlSocket(const ControlSocket&) = delete;
  ControlSocket& operator=(const ControlSocket&) = delete;

 private:
  void serve() noexcept;
  void talk(int peer) noexcept;

  std::filesystem::path path_;
  Answer answer_;
  wire::FileDescriptor listener_;
  std::atomic<bool> ending_{false};
  std::thread thread_;
};

/// Says a line to the run that listens at `path` and returns its answer. Throws StartupError where none does.
[[nodiscard]] std::string ask(const std::filesystem::path& path, const std::string& line);

}  // namespace jaywalk
