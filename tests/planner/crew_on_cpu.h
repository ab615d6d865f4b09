#pragma once
// A crew of threads of the CPU: the code that a device runs in one kernel, with other barriers. A thread sanitizer sees
// a barrier that is missing.
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "planner/field/start_tiles.h"
#include "planner/field/strips.h"
#include "tests/planner/one_memory.h"

namespace jaywalk::test {

/// Where `count` threads wait for one another, any number of times.
class Meeting {
 public:
  explicit Meeting(std::int32_t count) : count_(count) {}
  void meet() {
    std::unique_lock lock(mutex_);
    const std::int64_t round = rounds_;
    if (++here_ < count_) {
      all_here_.wait(lock, [&] { return rounds_ > round; });
      return;
    }
    here_ = 0;
    ++rounds_;
    all_here_.notify_all();
  }
  [[nodiscard]] std::int64_t rounds() const { return rounds_; }

 private:
  std::mutex mutex_;
  std::condition_variable all_here_;
  std::int32_t count_, here_ = 0;
  std::int64_t rounds_ = 0;
};

/// `kBlocks` blocks of `kThreads` threads; steps of at most `kAlone` cells are the first block's.
template <std::int32_t kBlocks, std::int32_t kThreads, std::int32_t kAlone>
class CrewOnCpu : public OneMemory {
 public:
  class Place {
   public:
    Place(CrewOnCpu& crew, std::int32_t block, std::int32_t thread) : crew_(&crew), block_(block), thread_(thread) {}
    [[nodiscard]] std::int32_t thread() const { return block_ * kThreads + thread_; }
    [[nodiscard]] static std::int32_t threads() { return kBlocks * kThreads; }
    [[nodiscard]] std::int32_t block_thread() const { return thread_; }
    [[nodiscard]] static std::int32_t block_threads() { return kThreads; }
    [[nodiscard]] std::int32_t block() const { return block_; }
    [[nodiscard]] static std::int32_t blocks() { return kBlocks; }
    [[nodiscard]] bool in_first_block() const { return block_ == 0; }
    [[nodiscard]] static std::int32_t most_alone() { return kAlone; }
    [[nodiscard]] static std::int32_t log2_of(std::int32_t n) {
      std::int32_t log2 = 0;
      while ((1 << log2) < n) ++log2;
      return log2;
    }
    void meet_crew() const { crew_->crew_meeting_.meet(); }
    void meet_block() const { crew_->block_meetings_[static_cast<std::size_t>(block_)]->meet(); }
    [[nodiscard]] void* memory() const { return crew_->tiles_[static_cast<std::size_t>(block_)].get(); }
    template <class T>
    static T peek(const T* at) {
      return std::atomic_ref(*const_cast<T*>(at)).load();
    }
    template <class T>
    static void put(T* at, T value) {
      std::atomic_ref(*at).store(value);
    }
    static void lower(std::uint32_t* at, std::uint32_t value) {
      const std::atomic_ref low(*at);
      for (std::uint32_t here = low.load(); value < here && !low.compare_exchange_weak(here, value);) {
      }
    }
    static void set_bits(std::int32_t* at, std::int32_t bits) { std::atomic_ref(*at).fetch_or(bits); }
    static std::int32_t swap(std::int32_t* at, std::int32_t value) { return std::atomic_ref(*at).exchange(value); }
    static std::int32_t add(std::int32_t* at, std::int32_t value) { return std::atomic_ref(*at).fetch_add(value); }
    static void fence() {}
    static void pause() { std::this_thread::yield(); }
    [[nodiscard]] field::Counted sum_of_block(field::Counted mine) const {
      crew_->counted_[static_cast<std::size_t>(thread())] = mine;
      meet_block();
      const field::Counted sum =
          field::SerialExecutor::total(kThreads, &crew_->counted_[static_cast<std::size_t>(block_ * kThreads)]);
      meet_block();
      return sum;
    }

   private:
    CrewOnCpu* crew_;
    std::int32_t block_, thread_;
  };

  CrewOnCpu() {
    for (auto& meeting : block_meetings_) meeting = std::make_unique<Meeting>(kThreads);
    for (auto& tile : tiles_) tile = std::make_unique<field::StartTile>();
  }
  [[nodiscard]] static std::int32_t most_blocks() { return kBlocks; }

  static constexpr std::int32_t kColumns = field::Crew<Place>::kColumns;
  static constexpr std::int32_t kCellsOfRow = field::Crew<Place>::kCellsOfRow;

  template <class Order>
  bool run(const Order& order) {
    std::vector<std::thread> threads;
    for (std::int32_t k = 0; k < kBlocks * kThreads; ++k) {
      threads.emplace_back([this, &order, k] {
        field::Crew<Place> crew(Place(*this, k / kThreads, k % kThreads), notes_);
        order(crew);
      });
    }
    for (std::thread& thread : threads) thread.join();
    return true;
  }

  [[nodiscard]] const char* name() const noexcept { return "crew"; }
  /// Times that all threads, and those of the first block alone, have met.
  [[nodiscard]] std::int64_t crew_meetings() const { return crew_meeting_.rounds(); }
  [[nodiscard]] std::int64_t block_meetings() const { return block_meetings_[0]->rounds(); }

 private:
  field::CrewNotes notes_{this->template take<field::Counted>(field::CrewNotes::kRoom),
                          this->template take<field::Counted>(field::CrewNotes::kTold)};
  Meeting crew_meeting_{kBlocks * kThreads};
  std::array<std::unique_ptr<Meeting>, std::size_t{kBlocks}> block_meetings_;
  std::array<std::unique_ptr<field::StartTile>, std::size_t{kBlocks}> tiles_;
  std::array<field::Counted, std::size_t{kBlocks} * kThreads> counted_{};
};

}  // namespace jaywalk::test
