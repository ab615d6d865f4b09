# Flags that every target shares. They are part of correctness: the same source must give the same
# bits with any optimisation level, sanitizer, compiler and processor (docs/explanation/conventions.md).
add_library(jaywalk_flags INTERFACE)
target_compile_features(jaywalk_flags INTERFACE cxx_std_20)
target_include_directories(jaywalk_flags INTERFACE ${PROJECT_SOURCE_DIR})

set(JAYWALK_CXX_FLAGS
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wold-style-cast
    -ffp-contract=off # GCC fuses a*b+c by default on aarch64, which changes results
    -fno-math-errno # lets sqrt be one instruction; its value stays the IEEE one
    -fno-trapping-math # lets comparisons vectorise; values stay the IEEE ones
    -fsigned-char) # plain char is unsigned on aarch64

# g++ 12's vectoriser makes fused instructions out of x - y and x + y side by side whatever -ffp-contract says, where the
# processor is said to have them (-march=native, x86-64-v3).
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  list(APPEND JAYWALK_CXX_FLAGS -mno-fma)
endif()

# Sources joined (tools/test, CMAKE_UNITY_BUILD): to g++ what is local to a file then lies in an included one.
if(CMAKE_UNITY_BUILD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND JAYWALK_CXX_FLAGS -Wno-subobject-linkage)
endif()

# The fast linker, where it is and the compiler knows it (g++ from 12.1).
include(CheckLinkerFlag)
find_program(JAYWALK_MOLD mold)
if(JAYWALK_MOLD)
  check_linker_flag(CXX -fuse-ld=mold JAYWALK_LINKS_BY_MOLD)
endif()
if(JAYWALK_LINKS_BY_MOLD)
  target_link_options(jaywalk_flags INTERFACE -fuse-ld=mold)
endif()

# Warnings are errors with the compilers that the project is tried with. A newer one may know new
# warnings, and those must not keep a newcomer from building.
set(JAYWALK_TRIED_COMPILER OFF)
if((CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
   OR (CMAKE_CXX_COMPILER_ID STREQUAL "Clang" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 15))
  set(JAYWALK_TRIED_COMPILER ON)
endif()
option(JAYWALK_WARNINGS_ARE_ERRORS "Stop at a warning" ${JAYWALK_TRIED_COMPILER})
if(JAYWALK_WARNINGS_ARE_ERRORS)
  list(APPEND JAYWALK_CXX_FLAGS -Werror)
endif()
foreach(flag IN LISTS JAYWALK_CXX_FLAGS)
  target_compile_options(jaywalk_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:${flag}>)
endforeach()

set(JAYWALK_SANITIZE "" CACHE STRING "Sanitizers to build with, for example address,undefined")
if(JAYWALK_SANITIZE)
  target_compile_options(jaywalk_flags INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-fsanitize=${JAYWALK_SANITIZE}>
    $<$<COMPILE_LANGUAGE:CXX>:-fno-omit-frame-pointer> $<$<COMPILE_LANGUAGE:CXX>:-fno-sanitize-recover=all>
    $<$<COMPILE_LANGUAGE:CXX>:-Wno-error=maybe-uninitialized>)  # g++ 12 is wrong of std::regex there
  target_link_options(jaywalk_flags INTERFACE -fsanitize=${JAYWALK_SANITIZE})
endif()
