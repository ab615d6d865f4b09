// Nothing of its own: it is there for what the tests include (CMakeLists.txt).
