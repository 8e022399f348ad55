// Plug-ins that do not keep to the seam, one a library: HOSTILE says which.
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include <unistd.h>

#include "kadans/control/plugin_glue.h"
#include "spring.h"

namespace {

using namespace kadans;

[[maybe_unused]] PluginType spring(const char* name) { return plugin_type<make_spring>(name); }

[[maybe_unused]] Plugin* good() {
  static PluginType types[] = {spring("hostile")};
  static Plugin plugin = plugin_sizes();
  plugin.type_count = 1;
  plugin.types = types;
  return &plugin;
}

[[maybe_unused]] PluginType& type_of(Plugin* plugin) { return const_cast<PluginType&>(plugin->types[0]); }

[[maybe_unused]] std::unique_ptr<ControlObject> make_nothing(const ObjectSetup&) { return nullptr; }

struct [[maybe_unused]] NoException {};

// For ever; who tests it hears of it.
[[maybe_unused]] void hang() {
  (void)!write(STDERR_FILENO, "hangs now\n", 10);
  for (;;) pause();
}

}  // namespace

#define EXPORT extern "C" __attribute__((visibility("default"))) const kadans::Plugin* kadans_plugin()

#if defined(HOSTILE_loaded)  // tells that it was, by a file
namespace {
const struct Loaded {
  Loaded() {
    if (const char* file = std::getenv("KADANS_TEST_LOADED")) std::ofstream(file) << "loaded";
  }
} loaded;
}  // namespace
EXPORT { return good(); }
#elif defined(HOSTILE_wrong_version)
EXPORT {
  Plugin* plugin = good();
  plugin->abi_version = 7;
  return plugin;
}
#elif defined(HOSTILE_other_frames)
EXPORT {
  Plugin* plugin = good();
  plugin->actuation_frame_size += 8;
  return plugin;
}
#elif defined(HOSTILE_missing_symbol)
extern "C" __attribute__((visibility("default"))) const kadans::Plugin* kadans_plugins() { return good(); }
#elif defined(HOSTILE_nothing)
EXPORT { return nullptr; }
#elif defined(HOSTILE_throwing_entry)
EXPORT { throw std::runtime_error("boo"); }
#elif defined(HOSTILE_many_types)
EXPORT {
  Plugin* plugin = good();
  plugin->type_count = 4'000'000'000;
  return plugin;
}
#elif defined(HOSTILE_bad_name)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).name = "Bad.Name";
  return plugin;
}
#elif defined(HOSTILE_missing_function)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).read_signals = nullptr;
  return plugin;
}
#elif defined(HOSTILE_name_taken)
KADANS_PLUGIN(plugin_type<make_spring>("joint_pid"))
#elif defined(HOSTILE_makes_nothing)
KADANS_PLUGIN(plugin_type<make_nothing>("hostile"))
#elif defined(HOSTILE_throwing_create)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).create = [](const PluginSetup*, PluginError*) -> void* { throw NoException{}; };
  return plugin;
}
#elif defined(HOSTILE_throwing_declare)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).declare = [](void*, const PluginDeclaration*, PluginError*) -> std::int32_t { throw 1; };
  return plugin;
}
#elif defined(HOSTILE_refusing_declare)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).declare = [](void*, const PluginDeclaration*, PluginError* error) -> std::int32_t {
    for (char& letter : error->text) letter = 'x';  // without an end
    return 0;
  };
  return plugin;
}
#elif defined(HOSTILE_declaring_twice)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).declare = [](void*, const PluginDeclaration* program, PluginError*) -> std::int32_t {
    for (int i = 0; i < 2; ++i) program->parameter(program->program, "k", "", 0, 1, 0, nullptr);
    return 1;
  };
  return plugin;
}
#elif defined(HOSTILE_throwing_step)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).step = [](void*, const PluginInput* input, ActuationFrame* actuation) {
    actuation->joints[1] = {.effort_Nm = 1, .mode = ActuationMode::effort};
    if (input->time_ns >= 5'000'000) throw std::runtime_error("boo");
  };
  return plugin;
}
#elif defined(HOSTILE_crashing_step)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).step = [](void*, const PluginInput* input, ActuationFrame*) {
    if (input->time_ns >= 100'000'000) std::raise(SIGSEGV);
  };
  return plugin;
}
#elif defined(HOSTILE_hanging_step)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).step = [](void*, const PluginInput* input, ActuationFrame*) {
    if (input->time_ns >= 100'000'000) hang();
  };
  return plugin;
}
#elif defined(HOSTILE_hanging_update)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).update = [](void*, const Snapshot* snapshot) {
    if (snapshot->time_ns >= 100'000'000) hang();
  };
  return plugin;
}
#elif defined(HOSTILE_not_finite)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).step = [](void*, const PluginInput*, ActuationFrame* actuation) {
    for (JointActuation& joint : actuation->joints) joint = {.effort_Nm = std::nan(""), .mode = ActuationMode::effort};
  };
  type_of(plugin).motion_remaining_s = [](void*) { return std::nan(""); };
  return plugin;
}
#elif defined(HOSTILE_throwing_update)
EXPORT {
  Plugin* plugin = good();
  type_of(plugin).update = [](void*, const Snapshot*) { throw std::runtime_error("boo"); };
  return plugin;
}
#endif
