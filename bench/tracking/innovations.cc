#include "bench/tracking/innovations.h"

#include <cmath>

#include "firmware/control_loop.h"
#include "firmware/recording/recorded_hal.h"
#include "firmware/recording/recorder.h"

namespace jaywalk::bench {
namespace {

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
  std::map<std::uint32_t, std::uint32_t> hits;
  for (const Track& track : tracks) {
    hits[track.id] = track.hits;
    const auto before = hits_before_.find(track.id);
    if (!track.moving || before == hits_before_.end() || track.hits == before->second) continue;
    count_ += 1;
    sum_ += track.nis;
    within_ += track.nis <= kWithin95 ? 1U : 0U;
  }
  hits_before_ = std::move(hits);
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
  ControlLoop loop(setup, devices.hal(setup.model.lasers().size()), planner, recorder);
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
