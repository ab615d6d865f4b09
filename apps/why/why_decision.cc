#include "apps/why/why_decision.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>
#include <utility>

#include "apps/report/csv_file.h"

namespace jaywalk {
namespace {

constexpr float kWorthSaying_s = 0.05F;

/// The terms beside the time, in the order of the table's columns.
std::array<std::pair<const char*, float>, 7> terms_of(const motion::Cost& cost) {
  return {{{"of meeting somebody", cost.conflict},
           {"of touching", cost.touch},
           {"of being braked", cost.stop_zone},
           {"near walls", cost.clearance},
           {"over unseen ground", cost.unseen},
           {"near people", cost.nearness},
           {"of comfort", cost.comfort}}};
}

std::string seconds(float value, const char* what) {
  char words[64];
  std::snprintf(words, sizeof words, "%.1f s %s", static_cast<double>(value), what);
  return words;
}

Vec2 place_of(const motion::RobotState& s) { return {static_cast<double>(s.x), static_cast<double>(s.y)}; }

std::vector<Vec2> way_of(const motion::RobotState& start,
                         const std::array<motion::RobotState, motion::kSteps>& driven) {
  std::vector<Vec2> way{place_of(start)};
  for (const motion::RobotState& s : driven) way.push_back(place_of(s));
  return way;
}

/// The name of a proposal in why.csv, and its words in a sentence. With a switch the compiler reports a missing one.
std::pair<const char*, const char*> names_of(motion::Proposal proposal) {
  using motion::Proposal;
  switch (proposal) {
    case Proposal::kLast:
      return {"last", "go on as decided before"};
    case Proposal::kFollow:
      return {"follow", "follow the way"};
    case Proposal::kWaitThenGo:
      return {"wait_then_go", "wait and then go"};
    case Proposal::kGoThenStop:
      return {"go_then_stop", "go and then stop"};
    case Proposal::kArc:
      return {"arc", "drive an arc"};
    case Proposal::kArcBack:
      return {"arc_back", "back off in an arc"};
    case Proposal::kArcThenFollow:
      return {"arc_then_follow", "drive an arc, then follow the way"};
    case Proposal::kBackThenFollow:
      return {"back_then_follow", "back off, then follow the way"};
    case Proposal::kStick:
      return {"wish", "drive as the stick asks"};
    case Proposal::kGoStraight:
      return {"go_straight", "turn and drive straight on"};
    case Proposal::kBrake:
      return {"brake", "brake as hard as it can"};
  }
  return {"unknown", "do something unknown"};
}

}  // namespace

DecisionScene scene_of(const motion::GoalRollouts& motion, const std::vector<motion::Alternative>& alternatives) {
  constexpr int kEvery = 5;  // steps: a second
  const motion::Decision& decision = motion.decision();
  DecisionScene scene;
  std::set<motion::Proposal> told{decision.trajectory.proposal};
  for (const motion::Alternative& a : alternatives) {
    const motion::Proposal kind = a.trajectory.proposal;
    if (!told.insert(kind).second) continue;
    std::string name = names_of(kind).first;
    std::replace(name.begin(), name.end(), '_', ' ');
    scene.ways.push_back({std::move(name), way_of(decision.start, a.driven), a.cost.total() - decision.cost.total()});
  }
  scene.chosen = way_of(decision.start, decision.driven);
  for (std::size_t m = 0; m < motion.futures().movers(); ++m) {
    for (int step = 0; step < motion::kFutureSteps; step += kEvery) {
      const motion::MoverAt& at = motion.futures().at(step, m);
      const double share = static_cast<double>(step) / (motion::kFutureSteps - 1);
      for (int k = 0; k < motion::kFutures; ++k)
        scene.futures.push_back({{static_cast<double>(at.x[k]), static_cast<double>(at.y[k])}, share});
    }
  }
  return scene;
}

const char* name_of(motion::Proposal proposal) { return names_of(proposal).second; }

std::string in_words(const motion::Cost& cost) {
  std::string words = seconds(cost.time, "to the goal");
  for (const auto& [what, value] : terms_of(cost)) {
    if (value >= kWorthSaying_s) words += ", " + seconds(value, what);
  }
  return words;
}

void write_alternatives(const std::vector<motion::Alternative>& alternatives, const std::string& file) {
  CsvFile table(file,
                "attempt,perturbed,total_s,time_s,conflict_s,touch_s,stop_zone_s,clearance_s,unseen_s,nearness_s,"
                "comfort_s,end_x_m,end_y_m,end_heading_rad,end_v_mps,first_v_mps,first_w_radps");
  const auto number = [&table](float value) { table.number(static_cast<double>(value)); };
  for (const motion::Alternative& a : alternatives) {
    table.text(names_of(a.trajectory.proposal).first).count(a.trajectory.perturbed ? 1 : 0);
    number(a.cost.total());
    number(a.cost.time);
    for (const auto& term : terms_of(a.cost)) number(term.second);
    const motion::RobotState& end = a.driven.back();
    for (const float value : {end.x, end.y, end.heading, end.v}) number(value);
    number(a.trajectory.commands.front().v);
    number(a.trajectory.commands.front().w);
    table.end_row();
  }
  (void)table.close();
}

}  // namespace jaywalk
