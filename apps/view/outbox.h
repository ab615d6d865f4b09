#pragma once
#include <deque>
#include <memory>
#include <string>
#include <utility>

namespace jaywalk::view {

/// Messages that wait to be sent to one client: kMostBytes and one message at most, whatever it asks for. Clients
/// that are sent the same message share its body.
class Outbox {
 public:
  static constexpr std::size_t kMostBytes = 512U << 10U;

  struct Message {
    std::string head;
    std::shared_ptr<const std::string> body;
    bool is_text = true;
  };
  /// False: there was no room for it.
  bool add(Message message) {
    if (bytes_ >= kMostBytes) return false;
    bytes_ += size(message);
    waiting_.push_back(std::move(message));
    return true;
  }
  [[nodiscard]] const Message& front() const { return waiting_.front(); }
  void pop() {
    bytes_ -= size(front());
    waiting_.pop_front();
  }
  [[nodiscard]] bool is_empty() const noexcept { return waiting_.empty(); }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

 private:
  /// Small ones count for what it takes to keep them.
  static std::size_t size(const Message& message) {
    return sizeof message + message.head.size() + message.body->size();
  }
  std::deque<Message> waiting_;
  std::size_t bytes_ = 0;
};

}  // namespace jaywalk::view
