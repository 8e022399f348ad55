// Plug-ins that break their promise, one a library: HOSTILE_... says which.
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <unistd.h>

#include "kadans/control/plugin.h"
#include "spring.h"

namespace {

using namespace kadans;

// For ever; who tests it hears of it.
[[maybe_unused]] void hang() {
  (void)!write(STDERR_FILENO, "hangs now\n", 10);
  for (;;) pause();
}

[[maybe_unused]] void crash() { std::raise(SIGSEGV); }

enum class Where { step, update };

// Does nothing, but for `strike` after 0.1 s.
template <Where where, void (*strike)()>
class Bomb final : public ControlObject {
 public:
  void declare(Declaration&) override {}
  void start(const ControlInput&) noexcept override {}
  void step(const ControlInput& input, ActuationFrame&) noexcept override {
    if (where == Where::step && input.time_ns >= 100'000'000) strike();
  }
  void set_point(std::uint32_t, double, double) noexcept override {}
  void cancel_motion(std::uint32_t) noexcept override {}
  double motion_remaining_s() const noexcept override { return 0; }
  void update(const Snapshot& snapshot) override {
    if (where == Where::update && snapshot.time_ns >= 100'000'000) strike();
  }
};

template <Where where, void (*strike)()>
std::unique_ptr<ControlObject> make_bomb(const ObjectSetup&) {
  return std::make_unique<Bomb<where, strike>>();
}

struct OwnException : std::runtime_error {
  using std::runtime_error::runtime_error;
};

[[maybe_unused]] std::unique_ptr<ControlObject> make_nothing(const ObjectSetup&) { return nullptr; }
[[maybe_unused]] std::unique_ptr<PlantType> make_no_plant() { return nullptr; }
[[maybe_unused]] std::unique_ptr<ControlObject> refuse_option(const ObjectSetup&) {
  throw OptionError("loop", "of no use here");
}
[[maybe_unused]] std::unique_ptr<ControlObject> throw_own(const ObjectSetup&) { throw OwnException("boo"); }

[[maybe_unused]] constexpr PluginType springs[] = {plugin_type<make_spring>("hostile")};

// The descriptor of a plug-in of one spring, changed by hand.
[[maybe_unused]] constexpr PluginDescriptor of_springs() { return plugin_of(springs); }

#if defined(HOSTILE_BUILD)
// As if part HOSTILE_BUILD of the build were another one.
constexpr PluginDescriptor of_another_build() {
  PluginDescriptor plugin = of_springs();
  int part = 0;
  for (char* letter = plugin.build; *letter != '\0'; ++letter) {
    if (letter[0] == ',' && letter[1] == ' ') ++part;
    if (part != HOSTILE_BUILD) continue;
    letter[part == 0 ? 0 : 2] = '?';
    break;
  }
  return plugin;
}
#endif

}  // namespace

#define DESCRIPTOR constinit const kadans::PluginDescriptor kadans_plugin

#if defined(HOSTILE_BUILD)
DESCRIPTOR = of_another_build();
#elif defined(HOSTILE_loaded)  // tells that it was, by a file
namespace {
const struct Loaded {
  Loaded() {
    if (const char* file = std::getenv("KADANS_TEST_LOADED")) std::ofstream(file) << "loaded";
  }
} loaded;
}  // namespace
DESCRIPTOR = of_springs();
#elif defined(HOSTILE_crashing_step)
KADANS_PLUGIN(plugin_type<make_bomb<Where::step, crash>>("hostile"))
#elif defined(HOSTILE_hanging_step)
KADANS_PLUGIN(plugin_type<make_bomb<Where::step, hang>>("hostile"))
#elif defined(HOSTILE_hanging_update)
KADANS_PLUGIN(plugin_type<make_bomb<Where::update, hang>>("hostile"))
#elif defined(HOSTILE_missing_symbol)
extern "C" __attribute__((visibility("default"))) const PluginDescriptor kadans_plugins;
constinit const PluginDescriptor kadans_plugins = of_springs();
#elif defined(HOSTILE_other_kind)  // as plug-ins were, when their symbol was a function
DESCRIPTOR = [] {
  PluginDescriptor plugin = of_springs();
  plugin.magic[0] = 'K';
  return plugin;
}();
#elif defined(HOSTILE_other_size)
DESCRIPTOR = [] {
  PluginDescriptor plugin = of_springs();
  plugin.size += 8;
  return plugin;
}();
#elif defined(HOSTILE_nothing)
DESCRIPTOR = {};
#elif defined(HOSTILE_many_types)
DESCRIPTOR = {.count = 4'000'000'000, .types = springs};
#elif defined(HOSTILE_bad_name)
KADANS_PLUGIN(plugin_type<make_spring>("Bad.Name"))
#elif defined(HOSTILE_no_maker)
KADANS_PLUGIN(PluginType{.name = "hostile"})
#elif defined(HOSTILE_name_taken)
KADANS_PLUGIN(plugin_type<make_spring>("joint_pid"))
#elif defined(HOSTILE_no_plant)
KADANS_PLUGIN(plugin_type<make_no_plant>())
#elif defined(HOSTILE_refusing)
KADANS_PLUGIN(plugin_type<make_nothing>("makes_nothing"), plugin_type<refuse_option>("refuses_option"),
              plugin_type<throw_own>("throws_own"))
#endif
