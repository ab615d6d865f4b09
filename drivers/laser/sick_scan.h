#pragma once
#include "drivers/laser/cola_stream.h"
#include "drivers/laser/decoding.h"
#include "hal/types/laser_scan.h"

namespace jaywalk::sick {

/// What the telegram does not say about a TiM5xx or LMS1xx.
struct ScannerModel {
  float range_min_m = 0.05F;
  float range_max_m = 10.0F;
};

/// What a telegram says beside the scan.
struct ScanHeader {
  std::uint32_t serial_number = 0;
  std::uint16_t telegram_counter = 0;
  std::uint16_t scan_counter = 0;
  std::uint32_t scan_time_us = 0;  ///< the device's clock at the end of the sweep; wraps after 71 minutes
  std::uint32_t sent_time_us = 0;  ///< the same clock when it was handed to the interface
  bool warns_of_dirt = false;      ///< on its window; it can still measure
};

/// Decodes the body of an "LMDscandata" telegram into `scan`, all but its sequence, which is the caller's.
///
/// `arrival` is when its last byte came in; the scan's stamp is the first beam's time: arrival less the time that the
/// device held the scan (not believed beyond one period) less the sweep. Angles are turned so that 90 degrees of SICK,
/// straight ahead, are 0. Reserved distances, 0 above all, prove nothing: SICK says 0 for nothing in range as well as
/// for what is too dark or too near. What is farther than the model's greatest range leaves the beam free. Channels
/// other than DIST1 are passed over.
[[nodiscard]] Decoding decode_scan(Cola dialect, wire::Bytes body, const ScannerModel& model, Time arrival,
                                   LaserScan& scan, ScanHeader& header) noexcept;

}  // namespace jaywalk::sick
