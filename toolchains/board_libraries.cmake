# Libraries that the robot's program needs (maps, packed recordings) go into it, where the static ones are: a board then
# needs libc, libstdc++ and libm alone.
foreach(library yaml-cpp png16 z)
  find_library(JAYWALK_LIB_${library} NAMES lib${library}.a ${library} REQUIRED)
endforeach()
