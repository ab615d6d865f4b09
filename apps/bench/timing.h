#pragma once
#include <chrono>
#include <ctime>
#include <string>

#include "apps/report/distribution.h"

namespace jaywalk {

struct Timing {
  std::string what;
  double p50_ms = 0.0, p99_ms = 0.0;
  std::string backend;
};

/// Times `work`. On the CPU processor time of this one thread: what other programs take meanwhile does not count. On a
/// device wall time, submission and waiting included.
template <class Work>
Timing time(const char* what, int repeats, const std::string& backend, const Work& work) {
  Distribution took_ms;
  for (int k = 0; k < repeats; ++k) {
    const std::clock_t ticks = std::clock();
    const auto begin = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> wall_ms = std::chrono::steady_clock::now() - begin;
    took_ms.add(backend == "cpu" ? 1e3 * static_cast<double>(std::clock() - ticks) / CLOCKS_PER_SEC : wall_ms.count());
  }
  return {what, took_ms.quantile(0.5), took_ms.quantile(0.99), backend};
}

}  // namespace jaywalk
