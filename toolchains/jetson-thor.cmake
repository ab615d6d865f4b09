# Cross-building for Jetson Thor: JetPack 7, Ubuntu 24.04, glibc 2.39, Neoverse V3AE. Compilers before GCC 15 do not know
# it; Neoverse N2 has the same instructions (Armv9.0-A with SVE2). Otherwise as toolchains/jetson-orin.cmake says.
set(CMAKE_CXX_FLAGS_INIT "-mcpu=neoverse-n2")
include("${CMAKE_CURRENT_LIST_DIR}/aarch64-linux-gnu.cmake")
