#pragma once
#include <cstdio>

#include "apps/report/distribution.h"

namespace jaywalk::bench {
/// Prints the head of a table of distributions: median, 99th percentile, largest value.
inline void print_head(const char* what) {
  std::printf("| %-56s | %8s | %8s | %8s |\n|---|---|---|---|\n", what, "p50", "p99", "max");
}

/// Prints its row of one distribution, in the unit that `what` names.
inline void print_row(const char* what, const Distribution& figure) {
  std::printf("| %-56s | %8.3f | %8.3f | %8.3f |\n", what, figure.quantile(0.5), figure.quantile(0.99), figure.max());
}

}  // namespace jaywalk::bench
