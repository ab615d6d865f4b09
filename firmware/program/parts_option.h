#pragma once
#include <CLI/CLI.hpp>

#include "firmware/recording/run_parts.h"

namespace jaywalk {

/// --part-bytes and --keep-parts.
inline void add_parts(CLI::App& command, PartsKept& kept) {
  command
      .add_option("--part-bytes", kept.bytes,
                  "Recording and tables in parts of at most so many bytes, 200000 or more; 0: whole")
      ->type_name("UINT")
      ->capture_default_str();
  command.add_option("--keep-parts", kept.parts, "How many parts are kept, the one that is written among them")
      ->check(CLI::Range(2, 1'000'000))
      ->capture_default_str();
}

}  // namespace jaywalk
