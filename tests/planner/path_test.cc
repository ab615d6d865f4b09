#include "planner/paper/path.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <set>
#include <vector>

#include "planner/mapping/window.h"
#include "planner/paper/potential_stages.h"
#include "tests/support/catch.h"

using namespace jaywalk;

namespace {

const field::Window kWindow{{100, -50}, 64, 0.1};
const std::vector<float> kAllFree(64 * 64, 9.0F);

}  // namespace

TEST_CASE("the index matrix cuts no corner: a step is diagonal only between two free cells") {
  const paper::Grid grid{4};
  // The goal is (2, 2), one is at (1, 1); (2, 1) is a wall, so the diagonal is closed and the way is by (1, 2).
  paper::SerialExecutor executor;
  auto* const psi = paper::take_rows<float>(executor, 4);
  std::fill_n(psi, 16, 9.0F);
  psi[10] = 0.0F;
  psi[9] = 1.0F;
  psi[5] = 2.0F;
  psi[6] = cell::kNotFree;
  std::vector<std::uint8_t> index(16);
  executor.for_each_cell(4, 4, paper::IndexOfEachCell{grid, psi, index.data()});
  const paper::Step step = paper::step_of(index[5]);
  CHECK(step.di == 0);
  CHECK(step.dj == 1);
  psi[6] = 1.5F;
  executor.for_each_cell(4, 4, paper::IndexOfEachCell{grid, psi, index.data()});
  CHECK(paper::step_of(index[5]).di == 1);
  CHECK(index[10] == paper::kHere);
}

TEST_CASE("the eight steps are the eight neighbours, each once") {
  std::set<std::pair<int, int>> seen;
  for (std::uint8_t k = 0; k < paper::kHere; ++k) {
    const paper::Step s = paper::step_of(k);
    CHECK(((s.di == 0) != (s.dj == 0)) == (k < 4));
    CHECK(std::max(std::abs(s.di), std::abs(s.dj)) == 1);
    CHECK(seen.emplace(s.di, s.dj).second);
  }
  CHECK(seen.size() == 8);
}

TEST_CASE("a path cut at the capacity keeps its first part") {
  const paper::Grid grid{64};
  std::vector<std::uint8_t> index(64 * 64, 0);  // 0: one cell to the right
  std::vector<paper::Point> points(10);
  CHECK(paper::follow(grid, index.data(), 0, 63, {points.data(), 10}, 0) == 10);
  CHECK(points[9].x == 9.5F);
  index[5] = paper::kHere;  // a pit on the way
  CHECK(paper::follow(grid, index.data(), 0, 63, {points.data(), 10}, 0) == 0);
}

TEST_CASE("resampling starts and ends exactly and keeps 0.05 to 0.1 m between points") {
  const auto path = std::make_unique<Path>();
  std::vector<paper::Point> band;
  for (int k = 0; k < 40; ++k)
    band.push_back({static_cast<float>(k) + 0.5F, k < 20 ? 10.5F : 0.5F * static_cast<float>(k) + 0.5F});
  const Vec2 from{10.07, -3.93}, to{13.96, -2.99};
  paper::resample(kWindow, kAllFree.data(), {band.data(), 40}, from, to, *path);
  REQUIRE(path->size() > 30);
  CHECK((*path)[0] == from);
  CHECK(path->back() == to);
  for (std::size_t k = 1; k < path->size(); ++k) {
    CHECK(distance((*path)[k - 1], (*path)[k]) < 0.1001);
    CHECK(distance((*path)[k - 1], (*path)[k]) > 0.05);
  }
}

TEST_CASE("a path of one point and one that goes nowhere are drawn") {
  const auto path = std::make_unique<Path>();
  const paper::Point here[2] = {{5.5F, 5.5F}, {5.5F, 5.5F}};
  paper::resample(kWindow, kAllFree.data(), {here, 2}, {1.0, 2.0}, {1.0, 2.0}, *path);
  CHECK(path->size() >= 1);
  CHECK(path->back() == Vec2{1.0, 2.0});
}

TEST_CASE("a path goes by the band's corner where the straight line would cut through a cell that is not free") {
  // Right along row 10 for 4.1 cells, up along column 14 for 18.7: 23 pieces of 0.9913 cells. The fifth goes from
  // (13.97, 10.9) to (14.1, 11.76), through cell (13, 11) inside the bend.
  const auto path = std::make_unique<Path>();
  const paper::Point band[3] = {{10.0F, 10.9F}, {14.1F, 10.9F}, {14.1F, 29.6F}};
  const auto corner_in_map = kWindow.in_map({static_cast<double>(band[1].x), static_cast<double>(band[1].y)});
  const auto goes_by_corner = [&](const std::vector<float>& clearance) {
    paper::resample(kWindow, clearance.data(), {band, 3}, kWindow.in_map({10.0, 10.9}), kWindow.in_map({14.1, 29.6}),
                    *path);
    bool found = false;
    for (const Vec2& p : *path) found = found || distance(p, corner_in_map) < 1e-9;
    return found;
  };
  CHECK_FALSE(goes_by_corner(kAllFree));
  const std::size_t free_size = path->size();
  std::vector<float> clearance = kAllFree;
  clearance[11 * 64 + 13] = 0.0F;
  CHECK(goes_by_corner(clearance));
  CHECK(path->back() == kWindow.in_map({14.1, 29.6}));
  CHECK(path->size() <= free_size + 1);
}

TEST_CASE("a long path spreads its points to 0.2 m and beyond that is cut") {
  const auto path = std::make_unique<Path>();
  const field::Window wide{{100, -50}, 16384, 0.1};
  const std::vector<float> lowest_row(16384, 9.0F);
  std::vector<paper::Point> band;
  for (int k = 0; k < 6000; ++k) band.push_back({static_cast<float>(k), 0.0F});  // 600 m
  paper::resample(wide, lowest_row.data(), {band.data(), 6000}, {10.0, -5.0}, {609.9, -5.0}, *path);
  CHECK(path->back() == Vec2{609.9, -5.0});
  CHECK(distance((*path)[0], (*path)[1]) == Approx(599.9 / 4095).epsilon(1e-3));
  for (int k = 6000; k < 12000; ++k) band.push_back({static_cast<float>(k), 0.0F});  // 1.2 km
  paper::resample(wide, lowest_row.data(), {band.data(), 12000}, {10.0, -5.0}, {1209.9, -5.0}, *path);
  CHECK(path->full());
  CHECK(distance((*path)[0], (*path)[1]) == Approx(0.2).epsilon(1e-3));
  CHECK(path->back().x == Approx(10.0 + 4095 * 0.2).epsilon(1e-3));
}

TEST_CASE("the nearest cell is the nearest, and of equals the first by row") {
  const paper::Grid grid{64};
  const auto find = [&](const std::vector<std::int32_t>& wanted, std::int32_t radius) {
    return field::nearest_cell(grid, 10, 10, radius, [&](std::int32_t c) {
      return std::find(wanted.begin(), wanted.end(), c) != wanted.end();
    });
  };
  // (13, 10) is 3 away, (12, 12) 2.83 and found on an inner ring; (10, 7) is 3 away and in an earlier row.
  CHECK(find({grid.at(13, 10), grid.at(12, 12)}, 10) == grid.at(12, 12));
  CHECK(find({grid.at(14, 10), grid.at(13, 13)}, 10) == grid.at(14, 10));
  CHECK(find({grid.at(13, 10), grid.at(10, 7)}, 10) == grid.at(10, 7));
  CHECK(find({grid.at(13, 13)}, 4) == field::kNoCell);  // 4.24 away
  CHECK(find({grid.at(10, 10)}, 0) == grid.at(10, 10));
}
