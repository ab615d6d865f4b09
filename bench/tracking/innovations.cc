#include "bench/tracking/innovations.h"

#include <cmath>

#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "firmware/recording/recording_stream.h"
#include "planner/perception/kalman.h"

namespace jaywalk::bench {
namespace {

constexpr double kWithin95 = 5.991;  // chi-squared, two degrees of freedom: -2 ln 0.05

/// Asked for plans, it has none.
class NoPlanner final : public Planner {
 public:
  void submit(const PlanRequest&) noexcept override {}
  [[nodiscard]] const Plan& collect() noexcept override { return none_; }
  [[nodiscard]] FieldView view_field() const override { return {}; }
  [[nodiscard]] const char* backend() const noexcept override { return "none"; }

 private:
  Plan none_;
};

}  // namespace

void Innovations::add(std::span<const Track> tracks) {
  std::map<std::uint32_t, Track> now;
  for (const Track& track : tracks) {
    now[track.id] = track;
    const auto before = before_.find(track.id);
    const bool seen = before != before_.end() && track.hits == before->second.hits + 1;
    if (seen && track.moving) add(before->second, track);
  }
  before_ = std::move(now);
}

void Innovations::add(const Track& before, const Track& after) {
  Track predicted = before;
  predict(predicted, to_seconds(after.stamp - before.stamp), kBodyAccelStd);
  const double gain = 1.0 - after.covariance.pp / predicted.covariance.pp;
  const double step = distance(predicted.position_in_map, after.position_in_map);
  const double squared = step * step / (gain * predicted.covariance.pp);
  count_ += 1;
  sum_ += squared;
  within_ += squared <= kWithin95 ? 1U : 0U;
}

double Innovations::mean() const { return sum_ / static_cast<double>(count_); }
double Innovations::mean_bound() const { return 1.96 * 2.0 / std::sqrt(static_cast<double>(count_)); }
double Innovations::share_within_95() const { return static_cast<double>(within_) / static_cast<double>(count_); }

Innovations innovations_of(const std::filesystem::path& recording) {
  RecordingReader reader(recording.string());
  const ControlSetup setup = setup_from_text(reader.setup(), recording.string());
  if (setup.mode == PlanMode::kPaper) return {};
  TickRecord recorded;
  RecordedHal devices(recorded);
  NoPlanner planner;
  Recorder recorder({});
  ControlLoop loop(setup, devices.hal(), planner, recorder);
  Innovations innovations;
  std::uint32_t last = 0;
  while (reader.next(recorded)) {
    static_cast<void>(loop.tick(recorded.now));
    recorder.drain();
    if (recorded.scan.sequence != last) innovations.add(loop.tracker().tracks());
    last = recorded.scan.sequence;
  }
  return innovations;
}

}  // namespace jaywalk::bench
