#pragma once
#include <cstdint>
#include <span>

namespace jaywalk::test {

/// Makes scans, wheel readings and fixes of the bytes, shows them to a new localizer and tracker, and ends the process
/// where these break a promise: a pose, a doubt or a track that is not finite, more tracks than there may be.
///
/// A scan is a byte of choices, what they ask for, and runs: how many, then for each its beams and a range in
/// centimetres, so that few bytes make walls and bodies; or the ranges of the scan before. The whole row is shown
/// twice, so that what is seen for the first time is met again.
void fuzz_seeing(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace jaywalk::test
