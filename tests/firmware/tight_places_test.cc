// A wheelchair of 0.65 m x 1.10 m where its way is hardly wider than itself, simulated from start to goal.
#include <cmath>

#include "tests/firmware/simulated_drive.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

struct Start {
  std::uint64_t seed;
  Pose2 start;
};

/// Reaches the goal without touching anything; never faster backward than what nothing watches may be.
void check_arrives(const std::string& scenario, const Start& from, RobotModel model, double limit_s,
                   PlanMode mode = PlanMode::kFull) {
  INFO(scenario << " seed " << from.seed << " from " << from.start.x << " " << from.start.y << " "
                << from.start.heading);
  const auto edit = [&](sim::Scenario& s) {
    s.start = from.start;
    s.model = model;
  };
  SimulatedDrive drive(scenario, from.seed, edit, mode);
  double backward = 0.0;
  CHECK(drive.arrives(limit_s, [&](const TickRecord&) { backward = std::min(backward, drive.truth().twist.v_mps); }));
  CHECK(backward > -0.31);  // 0.3 m/s and the wheels' slip
}

}  // namespace

TEST_CASE("a wheelchair passes a door of 0.90 m, facing it, across it and turned away") {
  check_arrives("door", {1, {1.4, 1.4, 0.0}}, wheelchair(), 120.0);
  check_arrives("door", {2, {1.5, 3.8, -1.57}}, wheelchair(), 120.0);
  check_arrives("door", {3, {2.0, 2.7, 3.14}}, wheelchair(), 120.0);
}

TEST_CASE("a wheelchair rounds the corner of a corridor of 1.2 m") {
  check_arrives("corner", {1, {0.8, 0.8, 0.0}}, wheelchair(), 90.0);
  check_arrives("corner", {2, {1.2, 0.75, 0.05}}, wheelchair(), 90.0);
}

TEST_CASE("a wheelchair backs out of a dead end that it cannot turn in") {
  check_arrives("dead_end", {1, {6.8, 2.6, 0.0}}, wheelchair(), 90.0);
  check_arrives("dead_end", {2, {6.0, 2.65, 0.05}}, wheelchair(), 90.0);
}

TEST_CASE("a nearly round robot passes the same places, at its own speed in mode paper too") {
  check_arrives("door", {1, {1.4, 1.4, 0.0}}, p3dx(), 40.0);
  check_arrives("corner", {1, {0.8, 0.8, 0.0}}, p3dx(), 40.0);
  check_arrives("dead_end", {1, {6.8, 2.6, 0.0}}, p3dx(), 40.0);
  check_arrives("door", {1, {1.4, 1.4, 0.0}}, p3dx(), 40.0, PlanMode::kPaper);
  check_arrives("corner", {1, {0.8, 0.8, 0.0}}, p3dx(), 40.0, PlanMode::kPaper);
}
