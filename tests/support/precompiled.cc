// Nothing: its target holds the header that all tests' executables have precompiled (tests/CMakeLists.txt).
