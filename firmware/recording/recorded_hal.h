#pragma once
// Our own recording behind the HAL: each tick the devices say what they said then.
#include <array>
#include <memory>

#include "firmware/recording/tick_record.h"
#include "hal/hal.h"
#include "planner/cost_to_go/planner.h"

namespace jaywalk {

/// Shows one TickRecord, which its owner moves on by writing to it; keeps the controller's command for comparison.
class RecordedHal {
 public:
  explicit RecordedHal(const TickRecord& record)
      : scanners_{Scanner(record, 0), Scanner(record, 1), Scanner(record, 2), Scanner(record, 3)},
        wheels_(record),
        panel_(record),
        fixes_(record),
        clock_(record) {}

  /// `scanners`: how many the recorded robot has.
  [[nodiscard]] Hal hal(std::size_t scanners = 1) noexcept {
    Hal hal{scanners_[0], wheels_, panel_, fixes_, clock_};
    for (std::size_t k = 1; k < scanners; ++k) (void)hal.other_lasers.push_back(&scanners_[k]);
    return hal;
  }
  [[nodiscard]] const WheelCommand& commanded() const noexcept { return wheels_.commanded; }

 private:
  /// A device that looks at the record.
  template <class Device>
  struct Recorded : Device {
    explicit Recorded(const TickRecord& r) : record(r) {}
    const TickRecord& record;
  };
  struct Scanner : Recorded<LaserScanner> {
    Scanner(const TickRecord& r, std::size_t k) : Recorded(r), index(k) {}
    std::size_t index;
    LaserScan none{};  ///< of a record that has none of it
    [[nodiscard]] const LaserScan& latest() noexcept override {
      return index < record.scans().size() ? record.scans()[index] : none;
    }
  };
  struct Wheels : Recorded<DriveBase> {
    using Recorded::Recorded;
    [[nodiscard]] WheelState latest() noexcept override { return record.wheels; }
    void command(const WheelCommand& command) noexcept override { commanded = command; }
    WheelCommand commanded;
  };
  struct Panel : Recorded<OperatorPanel> {
    using Recorded::Recorded;
    [[nodiscard]] OperatorInput latest() noexcept override { return record.input; }
  };
  struct Fixes : Recorded<PoseSource> {
    using Recorded::Recorded;
    [[nodiscard]] const OutsideFix& latest() noexcept override { return record.fix; }
  };
  /// A tick asks for the time when its command is out.
  struct RecordedClock : Recorded<Clock> {
    using Recorded::Recorded;
    [[nodiscard]] Time now() noexcept override { return record.now + record.took; }
    void sleep_until(Time) noexcept override {}
  };

  std::array<Scanner, kMostScanners> scanners_;
  Wheels wheels_;
  Panel panel_;
  Fixes fixes_;
  RecordedClock clock_;
};

/// Plans at once, and hands each plan out in the tick in which the recording has it: a planner with a thread of its
/// own was late by whatever its machine made of it, and did not take what it was too busy for.
class HeldPlanner final : public Planner {
 public:
  /// `record` outlives it and shows the tick at hand.
  HeldPlanner(std::unique_ptr<Planner> planner, const TickRecord& record)
      : planner_(std::move(planner)), record_(record), shown_(&planner_->collect()) {}

  void submit(const PlanRequest& request) noexcept override {
    planner_->submit(request);
    submitted_ = submitted_ == 0 ? record_.plan_sequence + 1 : submitted_ + 1;  // others came before a later part
  }
  [[nodiscard]] bool is_busy() const noexcept override { return !record_.plan_asked; }
  [[nodiscard]] const Plan& collect() noexcept override {
    if (record_.plan_sequence == submitted_) shown_ = &planner_->collect();
    return *shown_;
  }
  [[nodiscard]] FieldView view_field() const override { return planner_->view_field(); }
  [[nodiscard]] const char* backend() const noexcept override { return planner_->backend(); }

 private:
  std::unique_ptr<Planner> planner_;
  const TickRecord& record_;
  const Plan* shown_;
  std::uint32_t submitted_ = 0;
};

}  // namespace jaywalk
