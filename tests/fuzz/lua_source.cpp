// Lua files from elsewhere: loaded as a behavior and played for a few ticks, under budgets of every kind as in `kadans
// run`, but smaller, so that many are tried.
#include <cstdint>
#include <optional>
#include <string>

#include "kadans/signal/input_error.h"
#include "script/fixture.h"

namespace {

using namespace kadans;

constexpr int ticks = 4;
constexpr ScriptLimits limits{.tick_instructions = 50'000,
                              .load_instructions = 200'000,
                              .tick_wall_ns = 1'000'000,
                              .load_wall_ns = 4'000'000,
                              .memory_bytes = std::size_t{1} << 20};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const script_test::Scripts scripts;
  static BehaviorLog silence;
  const auto file = scripts.write("behaviors/test.lua", {reinterpret_cast<const char*>(data), size});
  script_test::Engine engine;
  try {
    Behavior behavior({.root = scripts.root, .file = file, .limits = limits}, engine.robot.catalog, silence);
    for (int i = 0; i < ticks && behavior.tick(engine.snapshot, engine.sender); ++i) engine.step();
    behavior.stop(engine.snapshot, engine.sender);
  } catch (const InputError&) {  // what is wrong with it is told
  }
  return 0;
}
