// MRPT's Hokuyo client (libmrpt-hwdrivers) on our emulated scanner: it takes the scans as a UTM-30LX's.
// usage: mrpt_hokuyo_peer PORT
#include <mrpt/hwdrivers/CHokuyoURG.h>
#include <mrpt/obs/CObservation2DRangeScan.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <thread>

int main(int argc, char** argv) {
  if (argc != 2) return std::fputs("usage: mrpt_hokuyo_peer PORT\n", stderr), 2;
  mrpt::hwdrivers::CHokuyoURG client;
  client.setIPandPort("127.0.0.1", static_cast<unsigned>(std::atoi(argv[1])));
  if (!client.turnOn()) return std::fputs("mrpt: the scanner was not turned on\n", stderr), 1;
  constexpr int kWanted = 40;
  int scans = 0, wrong = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (scans < kWanted && std::chrono::steady_clock::now() < end) {
    bool is_there = false, failed = false;
    mrpt::obs::CObservation2DRangeScan scan;
    client.doProcessSimple(is_there, scan, failed);
    if (failed) return std::fputs("mrpt: hardware error\n", stderr), 1;
    if (!is_there) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    ++scans;
    // 1081 beams of a quarter of a degree; a round room of 3 m, and a post at 1 m from 75 to 105 degrees.
    const auto beams = scan.getScanSize();
    if (beams != 1081 || std::fabs(scan.aperture - 1.5F * static_cast<float>(M_PI)) > 0.01F) ++wrong;
    for (std::size_t k = 0; k < beams; ++k) {
      const double angle = (-135.0 + 0.25 * static_cast<double>(k)) * M_PI / 180.0;
      const double from_edge = std::fabs(std::fabs(angle - M_PI / 2) - M_PI / 12);
      const float expected = std::fabs(angle - M_PI / 2) < M_PI / 12 ? 1.0F : 3.0F;
      if (from_edge > 0.01 && (!scan.getScanRangeValidity(k) || std::fabs(scan.getScanRange(k) - expected) > 0.001F)) {
        ++wrong;
      }
    }
  }
  client.turnOff();
  std::printf("mrpt: %d scans, %d beams or shapes wrong\n", scans, wrong);
  return scans == kWanted && wrong == 0 ? 0 : 1;
}
