// Patterns of scripts: the sandbox's matcher does what LuaJIT's own does, wherever that ends.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "pattern_comparison.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static kadans::fuzz::PatternComparison comparison;
  if (!comparison.run({reinterpret_cast<const char*>(data), size})) return 0;
  if (comparison.sandbox() == comparison.lua()) return 0;
  std::fprintf(stderr, "sandbox:\n%s\nLuaJIT:\n%s\n", comparison.sandbox().c_str(), comparison.lua().c_str());
  std::abort();
}
