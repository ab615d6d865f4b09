#include "apps/report/picture/cairo_library.h"

#include <dlfcn.h>

#include <memory>

namespace jaywalk {
namespace {
/// False where the library has no such function.
template <typename Function>
bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  return function != nullptr;
}

}  // namespace

const CairoLibrary* load_cairo(const char* name) {
  void* const library = ::dlopen(name, RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) return nullptr;
  auto functions = std::make_unique<CairoLibrary>();
  bool complete = true;
#define JAYWALK_CAIRO_FIND(name) complete = find(library, "cairo_" #name, functions->name) && complete;
  JAYWALK_CAIRO_FUNCTIONS(JAYWALK_CAIRO_FIND)
#undef JAYWALK_CAIRO_FIND
  return complete ? functions.release() : nullptr;  // never unloaded: fontconfig keeps what it has read
}

const CairoLibrary* cairo_library() {
  static const CairoLibrary* const library = load_cairo("libcairo.so.2");
  return library;
}

}  // namespace jaywalk
