#include "apps/view/order_courier.h"

#include <utility>

#include "apps/view/background_thread.h"

namespace jaywalk::view {
namespace {

constexpr std::size_t kMostReplies = 64;
constexpr const char* kStop = "stop";

}  // namespace

OrderCourier::OrderCourier(Ask ask)
    : ask_(std::move(ask)),
      stop_thread_(background_thread("view stops", [this] { carry(stops_); })),
      goal_thread_(background_thread("view goals", [this] { carry(goals_); })) {}

OrderCourier::~OrderCourier() {
  {
    const std::scoped_lock lock(mutex_);
    ends_ = true;
  }
  changed_.notify_all();
  stop_thread_.join();
  goal_thread_.join();
}

void OrderCourier::put(Lane& lane, std::string line, Reply reply) {
  lane.line = std::move(line);
  lane.replies.size() < kMostReplies ? lane.replies.push_back(std::move(reply))
                                     : reply("heard; too many ask what becomes of it\n");
  changed_.notify_all();
}

void OrderCourier::stop(Reply reply) {
  const std::scoped_lock lock(mutex_);
  for (const Reply& waits : std::exchange(goals_.replies, {})) waits("taken back by a stop\n");
  goals_.line = goals_.is_on_its_way ? kStop : "";
  put(stops_, kStop, std::move(reply));
}

void OrderCourier::go(std::string line, Reply reply) {
  const std::scoped_lock lock(mutex_);
  put(goals_, std::move(line), std::move(reply));
}

void OrderCourier::carry(Lane& lane) {
  std::unique_lock lock(mutex_);
  const auto may_go = [&] {
    return !lane.line.empty() && (&lane == &stops_ || (stops_.line.empty() && !stops_.is_on_its_way));
  };
  for (;;) {
    changed_.wait(lock, [&] { return ends_ || may_go(); });
    if (!may_go()) return;
    const std::string line = std::exchange(lane.line, "");
    const std::vector<Reply> replies = std::exchange(lane.replies, {});
    lane.is_on_its_way = true;
    lock.unlock();
    const std::string said = ask_(line);
    for (const Reply& reply : replies) reply(said);
    lock.lock();
    lane.is_on_its_way = false;
    changed_.notify_all();
  }
}

}  // namespace jaywalk::view
