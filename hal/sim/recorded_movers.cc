#include "hal/sim/recorded_movers.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "hal/shown_text.h"
#include "hal/text_file.h"

namespace jaywalk::sim {
namespace {

struct Row {
  double t_s, id, x_m, y_m;
};

constexpr const char* kMoverRows = "write rows of t_s,id,x_m,y_m below a line that says so";

Row parse_row(const std::filesystem::path& file, int number, std::string line) {
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream words(line);
  Row row{};
  std::string rest;
  const bool whole = static_cast<bool>(words >> row.t_s >> row.id >> row.x_m >> row.y_m) && !(words >> rest);
  const bool sound = whole && std::fabs(row.t_s) < 1e7 && std::fabs(row.x_m) < 1e6 && std::fabs(row.y_m) < 1e6 &&
                     row.id == std::floor(row.id) && std::fabs(row.id) < 1e15;
  if (!sound) refuse_line(file, number, "\"" + shown(line) + "\" is not four numbers", kMoverRows);
  return row;
}

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<Row> rows;
  std::string line;
  int number = 0;
  while (std::getline(in, line)) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (number == 1) drop_byte_order_mark(line);
    if (number == 1 && line == "t_s,id,x_m,y_m") continue;
    if (number == 1) refuse_line(file, 1, "does not begin with t_s,id,x_m,y_m", kMoverRows);
    if (!line.empty()) rows.push_back(parse_row(file, number, line));
  }
  if (rows.empty()) refuse_line(file, number, "holds nobody", kMoverRows);
  return rows;
}

}  // namespace

RecordedMovers::RecordedMovers(std::span<const RecordedSpec> specs, std::uint32_t last_id)
    : specs_(specs.begin(), specs.end()) {
  for (const RecordedSpec& spec : specs_) load(spec);
  for (Person& person : people_) person.truth.id = ++last_id;
  present_.reserve(people_.size());
}

void RecordedMovers::load(const RecordedSpec& spec) {
  std::map<double, std::vector<Sample>> by_id;
  double begin = 1e9, end = -1e9;
  for (const Row& row : read_rows(spec.file)) {
    by_id[row.id].push_back({row.t_s, Vec2{row.x_m, row.y_m} + spec.offset});
    begin = std::min(begin, row.t_s);
    end = std::max(end, row.t_s);
  }
  for (auto& [id, samples] : by_id) {
    std::stable_sort(samples.begin(), samples.end(), [](const Sample& a, const Sample& b) { return a.t_s < b.t_s; });
    const MoverTruth truth{.position = samples.front().position, .radius_m = spec.radius_m, .on_legs = spec.legs};
    people_.push_back({std::move(samples), 1, &spec, begin, end - begin, truth});
  }
}

/// Sets the person's truth; false when not there at this time.
bool RecordedMovers::move(Person& person, double now_s) noexcept {
  double t = person.begin_s + now_s - person.spec->start_at_s;
  if (person.spec->loop && person.period_s > 0.0 && t >= person.begin_s) {
    t = person.begin_s + std::fmod(t - person.begin_s, person.period_s);
  }
  const auto& samples = person.samples;
  if (samples.size() < 2 || t < samples.front().t_s || t >= samples.back().t_s) return false;
  if (samples[person.next - 1].t_s > t) person.next = 1;  // the recording began anew
  while (samples[person.next].t_s <= t) ++person.next;
  const Sample& before = samples[person.next - 1];
  const Sample& after = samples[person.next];
  const Vec2 velocity = (after.position - before.position) * (1.0 / (after.t_s - before.t_s));
  person.truth.position = before.position + velocity * (t - before.t_s);
  person.truth.velocity = velocity;
  if (dot(velocity, velocity) > 0.0) person.truth.heading = atan2(velocity.y, velocity.x);
  return true;
}

void RecordedMovers::place(double now_s, const RobotBody& robot) noexcept {
  present_.clear();  // room for all was taken at construction
  for (Person& person : people_) {
    MoverTruth& truth = person.truth;
    const bool was_forced = truth.forced;
    truth.forced = false;
    if (!move(person, now_s)) continue;
    truth.forced = robot.in({truth.position, direction(truth.heading), truth.radius_m + kRecordedZone});
    if (truth.forced && !was_forced) ++forced_;
    present_.push_back(truth);
  }
}

}  // namespace jaywalk::sim
