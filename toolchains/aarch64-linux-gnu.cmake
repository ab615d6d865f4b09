# Cross-building for 64-bit ARM (Jetson, Raspberry Pi). Libraries come from a folder that
# tools/aarch64_root fills; tests run under qemu where it is installed.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_CXX_COMPILER aarch64-linux-gnu-g++)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)

get_filename_component(_project_dir "${CMAKE_CURRENT_LIST_DIR}" DIRECTORY)
set(JAYWALK_AARCH64_ROOT "${_project_dir}/build-aarch64-root" CACHE PATH "Folder with the aarch64 libraries")
list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES JAYWALK_AARCH64_ROOT)

set(CMAKE_FIND_ROOT_PATH "${JAYWALK_AARCH64_ROOT}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} "${JAYWALK_AARCH64_ROOT}")
set(ENV{PKG_CONFIG_LIBDIR} "${JAYWALK_AARCH64_ROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${JAYWALK_AARCH64_ROOT}/usr/share/pkgconfig")
# Where the linker finds what the libraries themselves need.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-rpath-link,${JAYWALK_AARCH64_ROOT}/usr/lib/aarch64-linux-gnu:${JAYWALK_AARCH64_ROOT}/lib/aarch64-linux-gnu")

find_program(JAYWALK_QEMU NAMES qemu-aarch64-static qemu-aarch64)
if(JAYWALK_QEMU)
  set(CMAKE_CROSSCOMPILING_EMULATOR "${JAYWALK_QEMU};-L;${JAYWALK_AARCH64_ROOT}")
endif()
