#pragma once
#include "cuda/emulated/device_functions.h"

namespace cooperative_groups {

struct grid_group {
  static void sync() { jaywalk::emulated::launch_under_way->meet_grid(); }
};
struct thread_block {
  static void sync() { jaywalk::emulated::launch_under_way->meet_block(); }
};
struct cluster_group {
  static void sync() { jaywalk::emulated::launch_under_way->meet_cluster(); }
  static unsigned num_blocks() { return jaywalk::emulated::launch_under_way->shape().cluster_blocks; }
  static unsigned block_rank() {
    return static_cast<unsigned>(jaywalk::emulated::launch_under_way->block()) % num_blocks();
  }
  /// Where a __shared__ variable lies in the memory of the cluster's block `rank`.
  template <class T>
  static T* map_shared_rank(T* variable, unsigned rank) {
    jaywalk::emulated::Launch& launch = *jaywalk::emulated::launch_under_way;
    const std::size_t first = launch.block() / num_blocks() * num_blocks();
    return static_cast<T*>(launch.shared_memory().of_block(variable, first + rank));
  }
};

inline grid_group this_grid() { return {}; }
inline thread_block this_thread_block() { return {}; }
inline cluster_group this_cluster() { return {}; }

}  // namespace cooperative_groups
