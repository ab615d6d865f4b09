// Catch2 v2's own main, for systems whose package brings its headers alone (tests/CMakeLists.txt).
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
