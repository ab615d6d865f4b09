#pragma once
#include <condition_variable>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "apps/view/view_door.h"

namespace jaywalk::view {

/// Takes orders of the page's to a run's control socket, which may take seconds to answer: stops in one thread, goals
/// in another. Of those that wait the newest goes, and answers the others. A stop takes back a goal that waits; a goal
/// that was on its way when the stop came is followed by one more stop, whichever arrives first. Any thread; does not
/// wait.
class OrderCourier {
 public:
  /// Says a line to the socket and waits for what is answered.
  using Ask = std::function<std::string(const std::string& line)>;

  explicit OrderCourier(Ask ask);
  ~OrderCourier();
  OrderCourier(const OrderCourier&) = delete;
  OrderCourier& operator=(const OrderCourier&) = delete;

  void stop(Reply reply);
  void go(std::string line, Reply reply);

 private:
  struct Lane {
    std::string line;  ///< waits; empty: none does
    std::vector<Reply> replies;
    bool is_on_its_way = false;
  };
  void carry(Lane& lane);
  void put(Lane& lane, std::string line, Reply reply);

  Ask ask_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Lane stops_, goals_;
  bool ends_ = false;
  std::thread stop_thread_, goal_thread_;
};

}  // namespace jaywalk::view
