#pragma once
#include "planner/mapping/evidence_map.h"

namespace jaywalk::tests {

/// A map in which everything from (-4, -4) to (6, 6) has been seen, free but for the walls drawn.
class WalledGround {
 public:
  WalledGround() : map_(256, 0.1, {1.0, 1.0}) {
    for (int j = -40; j < 60; ++j) {
      for (int i = -40; i < 60; ++i) map_.add({i, j}, -40);
    }
  }
  WalledGround& wall(Vec2 from, Vec2 to) {
    const int points = static_cast<int>(distance(from, to) / 0.01) + 1;
    for (int k = 0; k <= points; ++k) {
      for (int scan = 0; scan < 6; ++scan) map_.add_hit(from + (to - from) * (1.0 * k / points), 16, 0.2);
    }
    return *this;
  }
  void forget(CellIndex cell) { map_.forget(cell); }
  [[nodiscard]] const EvidenceMap& map() const { return map_; }

 private:
  EvidenceMap map_;
};

}  // namespace jaywalk::tests
