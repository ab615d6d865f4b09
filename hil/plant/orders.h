#pragma once
#include <string>
#include <string_view>

#include "hil/far_end/simulated_robot.h"

namespace jaywalk::rig {

/// What the far end is told to do wrong, a line an order:
///
///   emergency left|right CODE    a drive breaks, and says so (CODE as in CiA 301, or its own; hexadecimal)
///   unplug left|right            its cable is pulled; plug puts it back
///   lie left|right INDEX SUB     a CiA 402 drive acknowledges writes to an object (hexadecimal) and ignores them
///   lack left|right INDEX SUB    it has no such object
///   say 701#05                   a frame as another program would send it; eight digits: an extended identifier
///   scanner reset|half           the connection is torn; half a telegram comes
///   scanner halves|silence|garbage|gone SECONDS
///   scanner lose FROM_DEG TO_DEG a sector measures nothing, counter-clockwise in the laser's frame
///   scanner damage SHARE         of all messages so many are damaged, 0 to 1
///   scanner soiled|dirty         it warns of dirt on its window; it says that it can measure no more
///   scanner whole                an end of the last four
///
/// Returns what is wrong with the order; empty where it was obeyed.
[[nodiscard]] std::string obey(std::string_view order, SimulatedRobot& robot);

}  // namespace jaywalk::rig
