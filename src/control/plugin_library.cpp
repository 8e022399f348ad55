#include "kadans/control/plugin_library.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <span>
#include <stdexcept>

#include <dlfcn.h>

#include "plugin_object.h"

namespace kadans {
namespace {

constexpr std::uint32_t types_max = 64;
constexpr std::size_t name_max = 64;
using Entry = const Plugin* (*)();

[[noreturn]] void refuse_plugin(const std::filesystem::path& file, const std::string& why) {
  throw std::invalid_argument("plug-in " + file.string() + ": " + why);
}

Entry open_library(const std::filesystem::path& file) {
  void* library = dlopen(std::filesystem::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) refuse_plugin(file, std::string("cannot be loaded: ") + dlerror());
  void* entry = dlsym(library, "kadans_plugin");
  if (entry == nullptr) refuse_plugin(file, "exports no function kadans_plugin, so it is no plug-in of Kadans");
  return reinterpret_cast<Entry>(entry);
}

void check_sizes(const std::filesystem::path& file, const Plugin& plugin) {
  constexpr Plugin own = plugin_sizes();
  if (plugin.abi_version != own.abi_version) {
    refuse_plugin(file, "is made for version " + std::to_string(plugin.abi_version) +
                            " of the seam, this program has " + std::to_string(own.abi_version) + ": build it again");
  }
  const struct {
    const char* what;
    std::uint32_t size, wanted;
  } sizes[] = {{"Plugin", plugin.plugin_size, own.plugin_size},
               {"PluginType", plugin.type_size, own.type_size},
               {"PluginSetup", plugin.setup_size, own.setup_size},
               {"PluginLink", plugin.link_size, own.link_size},
               {"PluginJoint", plugin.joint_size, own.joint_size},
               {"PluginInput", plugin.input_size, own.input_size},
               {"PluginDeclaration", plugin.declaration_size, own.declaration_size},
               {"JointStates", plugin.joint_states_size, own.joint_states_size},
               {"RobotStatus", plugin.robot_status_size, own.robot_status_size},
               {"ActuationFrame", plugin.actuation_frame_size, own.actuation_frame_size},
               {"Snapshot", plugin.snapshot_size, own.snapshot_size}};
  for (const auto& size : sizes) {
    if (size.size == size.wanted) continue;
    refuse_plugin(file, std::string("was built with another ") + size.what + ": " + std::to_string(size.size) +
                            " bytes, this program has " + std::to_string(size.wanted));
  }
}

bool right_name(const char* name) {
  if (name == nullptr || strnlen(name, name_max + 1) > name_max || *name == '\0') return false;
  return std::all_of(name, name + std::strlen(name),
                     [](char c) { return c == '_' || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'); });
}

bool complete(const PluginType& type) {
  return type.create != nullptr && type.destroy != nullptr && type.declare != nullptr && type.start != nullptr &&
         type.step != nullptr && type.set_parameter != nullptr && type.parameters_changed != nullptr &&
         type.set_point != nullptr && type.cancel_motion != nullptr && type.motion_remaining_s != nullptr &&
         type.read_signals != nullptr && type.update != nullptr;
}

}  // namespace

void load_plugin(const std::filesystem::path& file, ControlObjectTypes& types) {
  const Entry entry = open_library(file);
  const Plugin* plugin = nullptr;
  try {
    plugin = entry();
  } catch (...) {
    refuse_plugin(file, "threw when it was asked what it brings");
  }
  if (plugin == nullptr) refuse_plugin(file, "does not say what it brings");
  check_sizes(file, *plugin);
  if (plugin->types == nullptr || plugin->type_count < 1 || plugin->type_count > types_max) {
    refuse_plugin(file, "brings " + std::to_string(plugin->type_count) + " types, 1.." + std::to_string(types_max) +
                            " are possible");
  }
  for (const PluginType& type : std::span(plugin->types, plugin->type_count)) {
    if (!right_name(type.name)) refuse_plugin(file, "names a type with other than 1..64 of a-z, 0-9 and _");
    if (!complete(type)) refuse_plugin(file, "lacks a function of type " + std::string(type.name));
    try {
      types.add(
          type.name, [&type](const ObjectSetup& setup) { return std::make_unique<PluginObject>(type, setup); },
          "the plug-in");
    } catch (const std::invalid_argument& error) {
      refuse_plugin(file, error.what());
    }
  }
}

}  // namespace kadans
