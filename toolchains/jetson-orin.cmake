# Cross-building for Jetson Orin: JetPack 6, Ubuntu 22.04, glibc 2.35, Cortex-A78AE. CUDA is built on the device itself
# (preset jetson-orin): no package holds its libraries for another machine. The libraries in JAYWALK_AARCH64_ROOT must
# not be newer than the device's: fill the folder with tools/aarch64_root on Ubuntu 22.04.
set(CMAKE_CXX_FLAGS_INIT "-mcpu=cortex-a78ae")
include("${CMAKE_CURRENT_LIST_DIR}/aarch64-linux-gnu.cmake")
