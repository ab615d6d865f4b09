// A NaN that comes from arithmetic has other bits on every kind of processor: an x86 keeps its operand's, an NVIDIA GPU
// returns 7fffffff. So psi of a cell that is not free is handed on as it is. A signalling NaN shows it: arithmetic sets
// its quiet bit (IEEE 754, 6.2.3), a copy does not.
#include <cstring>

#include "tests/planner/field_rig.h"
#include "tests/support/catch.h"

using namespace jaywalk;
using namespace jaywalk::test;

namespace {

constexpr std::uint32_t kSignalling = 0x7fa00001;

/// Visits one cell after the other. Of this file alone, so that the stages are compiled as the build says for this
/// file.
class Visitor : public paper::SerialExecutor {
 public:
  template <class Stage>
  void for_each_cell(std::int32_t w, std::int32_t h, const Stage& stage) {
    for (std::int32_t k = 0; k < w * h; ++k) {
      if constexpr (requires { stage(k, k); }) {
        stage(k % w, k / w);
      } else {
        stage(k);
      }
    }
  }
};

/// Cells that are not free whose bits are not the mark any more.
int computed(const FieldRig<Visitor>& rig, const float* psi) {
  int count = 0;
  for (std::int32_t c = 0; c < rig.grid.cells(); ++c) {
    count += rig.arrays().clearance[c] <= 0.0F && std::memcmp(psi + c, &kSignalling, sizeof kSignalling) != 0 ? 1 : 0;
  }
  return count;
}

}  // namespace

TEST_CASE("psi of a cell that is not free is handed on and never computed, cold, warm and by the start field alone") {
  FieldRig<Visitor> rig(64);
  rig.load(rooms(), 1.0F, rig.grid.at(55, 50));
  for (std::int32_t c = 0; c < rig.grid.cells(); ++c) {
    if (rig.arrays().clearance[c] <= 0.0F) std::memcpy(rig.arrays().start_psi + c, &kSignalling, sizeof kSignalling);
  }
  for (const paper::From from : {paper::From::kNothing, paper::From::kLast, paper::From::kStartOnly}) {
    const paper::FieldQuality quality = rig.solve(from);
    CHECK(quality.certified);
    CHECK(quality.joined > 2000);
    CHECK(computed(rig, rig.arrays().start_psi) == 0);
    CHECK(computed(rig, rig.psi()) == 0);
  }
}
