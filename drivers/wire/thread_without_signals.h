#pragma once
#include <functional>
#include <thread>

namespace jaywalk {

/// A thread to which no signal of the process goes: they are for the thread that knows what to do with them. `name`:
/// what ps shows, at most 15 characters.
[[nodiscard]] std::thread thread_without_signals(const char* name, std::function<void()> lives);

}  // namespace jaywalk
