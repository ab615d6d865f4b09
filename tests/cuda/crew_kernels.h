#pragma once
// Orders that ask one thing of a crew each: what plans of the tests' sizes need seldom or never.
#include <cstdint>

#include "cuda/crew_kernel.h"

namespace jaywalk::test {

/// The first block counts rounds alone, and all threads copy what it has counted, round by round.
struct CopyRounds {
  static constexpr std::int32_t kRounds = 4, kFew = 64, kAll = kMostAlone + 64;
  std::int32_t* few;     ///< kFew, zeros at first
  std::int32_t* copied;  ///< kRounds x kAll: 1, 2 and so on
};
__global__ void copy_rounds(CopyRounds order, field::CrewNotes notes);

/// Every thread keeps what it was told of two sums of the crew, one right after the other, and of two of its block.
struct SumTwice {
  static constexpr std::int32_t kPairs = field::CrewNotes::kFew;
  const field::Counted* counted;  ///< 2 x kPairs
  std::int32_t* told;             ///< 4 a thread
};
__global__ void sum_twice(SumTwice order, field::CrewNotes notes);

}  // namespace jaywalk::test
