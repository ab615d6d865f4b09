#pragma once
// The local socket through which a person, or a program, talks to a run: one line there, an answer back, the end.
//
//   goto X Y      the goal, m in the map         stop          no goal: the robot ramps to rest
//   goto X Y H    and its heading there, rad     stop now      emergency stop, latched
//   status        how it goes                    reset         after a latched fault, at rest
//   here X Y H    where it is, at rest
//
// Each client has a small buffer and a deadline of its own, and none can hold up another.
#include <sys/types.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <future>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "drivers/wire/file_descriptor.h"
#include "hal/types/time.h"

namespace jaywalk {

enum class StopWords : std::uint8_t { kNone, kStop, kStopNow };

/// Returns the strongest stop in any line of `text`: its first letters are "stop" or "halt", in either case, whatever
/// stands before and after them. "emergency", "estop" and "e-stop", and "now" in the line, stop at once.
[[nodiscard]] StopWords stop_in(std::string_view text) noexcept;

/// Answer to a line, or a job that takes longer: it runs in a thread of its own, and returns the answer.
struct ControlReply {
  ControlReply(std::string answer) : text(std::move(answer)) {}  // NOLINT: an answer in words is a reply
  ControlReply(const char* answer) : text(answer) {}             // NOLINT: the same
  explicit ControlReply(std::function<std::string()> longer) : job(std::move(longer)) {}

  std::string text;
  std::function<std::string()> job;
};

/// Serves any number of clients in rounds; nothing in a round waits. A round accepts kMostAccepted connections and
/// gives kMostAnswers answers at most, so a client that floods it slows only itself. When all places or descriptors are
/// taken, the process with most of them loses its oldest client.
///
/// A stop (stop_in()) is answered as soon as it is read, before all else, and is not counted: in the round that is
/// under way when it comes, or the next. It need not be a client's first line, nor have an end where its client has.
/// A descriptor is kept in reserve for it. Thread: one.
class ControlClients {
 public:
  /// Must not wait. What begins with "refused" tells the asker that it failed.
  using Answer = std::function<ControlReply(std::string_view line)>;
  static constexpr std::size_t kLongestLine = 200;
  static constexpr std::size_t kMostClients = 128, kMostAccepted = 512, kMostAnswers = 16;
  /// From connecting to the end of its line.
  static constexpr Duration kPatience = std::chrono::seconds(1);

  explicit ControlClients(Answer answer);

  /// Waits until a client of `listener` wants something, `longest` at most; less where an answer is still due.
  void wait(int listener, Duration longest);
  /// Accepts clients, reads and answers their orders, and drops clients that stayed silent too long.
  void serve(int listener, Time now);
  [[nodiscard]] std::size_t connected() const noexcept { return clients_.size(); }

 private:
  struct Client {
    wire::FileDescriptor socket;
    pid_t process = 0;
    Time since = kNever;
    std::array<char, 4 * kLongestLine> text{};
    std::size_t length = 0;
    enum class State : std::uint8_t { kTalks, kAsked, kAwaitsJob, kDone } state = State::kTalks;
    [[nodiscard]] std::string_view said() const noexcept { return {text.data(), length}; }
  };
  using State = Client::State;

  void accept_new(int listener, Time now);
  [[nodiscard]] wire::FileDescriptor accepted(int listener);
  /// Drops a client that is done, or the oldest of the process that has most. False: none can be spared.
  bool make_room();
  void read(Client& client);
  void end_line(Client& client, bool whole);
  void answer(Client& client);
  void start_job(Client& client, const std::function<std::string()>& job);
  void answer_job();
  void drop_done(Time now);

  Answer answer_;
  std::vector<Client> clients_;   ///< the oldest first
  wire::FileDescriptor reserve_;  ///< given up for a client where there is none left
  std::future<std::string> job_;
};

/// $JAYWALK_SOCKET, else jaywalk.sock in $XDG_RUNTIME_DIR, else in the folder for temporary files.
[[nodiscard]] std::filesystem::path default_control_socket();

/// Serves all clients in a thread of its own, a round of them every 5 ms at most: a flood takes a bounded share of a
/// processor, and a stop is read within two rounds (SAFETY: within 100 ms). Owner and group may talk.
class ControlSocket {
 public:
  using Answer = ControlClients::Answer;

  /// `priority`: the thread's (SCHED_FIFO; 0: ordinary). Throws StartupError where another run listens, or none can.
  ControlSocket(std::filesystem::path path, Answer answer, int priority = 0);
  ~ControlSocket();

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
