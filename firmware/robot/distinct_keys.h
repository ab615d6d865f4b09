#pragma once
// Numbers of ROBOT.toml that may not be one: nodes on a bus, buttons.
#include <cstdint>
#include <initializer_list>
#include <string>

#include "hal/toml_file.h"

namespace jaywalk {

/// What a key of a table says.
struct Numbered {
  const char* key;
  std::uint16_t value;
};

/// Refuses the first that repeats one before it.
inline void require_distinct(const TomlTable& table, std::initializer_list<Numbered> all) {
  for (const Numbered& one : all) {
    for (const Numbered* other = all.begin(); other != &one; ++other) {
      if (one.value == other->value)
        table.refuse(one.key, std::string("is ") + other->key + " too", "give each its own");
    }
  }
}

}  // namespace jaywalk
