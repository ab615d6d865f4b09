#include "tests/cuda/crew_kernels.h"

namespace jaywalk::test {
namespace {

struct CountOne {
  std::int32_t* to;
  JAYWALK_ORDER void operator()(std::int32_t k) const { (void)PlaceInGrid::add(to + k, 1); }
};

struct Copy {
  const std::int32_t* from;
  std::int32_t* to;
  JAYWALK_CELL void operator()(std::int32_t k) const { to[k] = from[k % CopyRounds::kFew]; }
};

}  // namespace

__global__ void copy_rounds(CopyRounds order, field::CrewNotes notes) {
  field::Crew<PlaceInGrid> crew(PlaceInGrid{}, notes);
  for (std::int32_t r = 0; r < CopyRounds::kRounds; ++r) {
    crew.for_each(CopyRounds::kFew, CountOne{order.few});
    crew.for_each(CopyRounds::kAll, Copy{order.few, order.copied + r * CopyRounds::kAll});
  }
}

__global__ void sum_twice(SumTwice order, field::CrewNotes notes) {
  field::Crew<PlaceInGrid> crew(PlaceInGrid{}, notes);
  std::int32_t* told = order.told + 4 * PlaceInGrid::thread();
  for (std::int32_t k = 0; k < 2; ++k)
    *told++ = crew.total(SumTwice::kPairs, order.counted + k * SumTwice::kPairs).cells;
  for (std::int32_t k = 0; k < 2; ++k) *told++ = PlaceInGrid::sum_of_block({k + 1, 0}).cells;
}

}  // namespace jaywalk::test
