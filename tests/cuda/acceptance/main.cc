//   device | parity | times | drill late|hang|broken|memory|number
//   [--sides 64,128] [--seeds 20] [--ticks 4] [--repeats 1000] [--limit-ms 50]
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "tests/cuda/acceptance/acceptance.h"

using namespace jaywalk::acceptance;

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "", name = argc > 2 ? argv[2] : "";
  Options options;
  for (int k = what == "drill" ? 3 : 2; k + 1 < argc; k += 2) {
    const std::string key = argv[k];
    const int value = std::atoi(argv[k + 1]);
    if (key == "--seeds") options.seeds = value;
    if (key == "--ticks") options.ticks = value;
    if (key == "--repeats") options.repeats = value;
    if (key == "--limit-ms") options.limit = std::chrono::milliseconds(value);
    if (key != "--sides") continue;
    options.sides.clear();
    std::istringstream sides(argv[k + 1]);
    for (std::string side; std::getline(sides, side, ',');) options.sides.push_back(std::atoi(side.c_str()));
  }
  if (what == "device") return device();
  if (what == "parity") return parity(options);
  if (what == "times") return times(options);
  if (what == "drill") return drill(name);
  std::fprintf(stderr, "usage: device | parity | times | drill NAME (this source's first lines)\n");
  return 2;
}
