// Makes a plug-in from control objects. Write in one source file of a shared library:
//
//   KADANS_PLUGIN(kadans::plugin_type<make_spring>("spring"), kadans::plugin_type<make_damper>("damper"))
//
// where make_spring is a std::unique_ptr<kadans::ControlObject> (const kadans::ObjectSetup&). The object sees the same
// model as in the program, except shapes and file names.
//
// What make_spring and declare() throw does not leave the library; it becomes the reason of a refusal. step() and the
// other functions of the control thread are noexcept in ControlObject: an exception that leaves one of them ends the
// process.
#pragma once

#include <cstdio>
#include <exception>
#include <iterator>
#include <memory>

#include "kadans/control/control_object.h"
#include "kadans/control/plugin.h"

namespace kadans {

// A control object on the plug-in's side, with tables of its own.
class PluginInstance {
 public:
  using Make = std::unique_ptr<ControlObject> (*)(const ObjectSetup&);
  PluginInstance(const PluginSetup& setup, Make make);  // throws what `make` throws

  void declare(const PluginDeclaration& program);  // throws what the object's declare() throws
  void start(const PluginInput& input) noexcept;
  void step(const PluginInput& input, ActuationFrame& actuation) noexcept;
  void set_parameter(std::uint32_t parameter, double value) noexcept;
  void read_signals(double* values) const noexcept;
  ControlObject& object() noexcept { return *object_; }

 private:
  RobotModel model_;
  ParameterTable parameters_;
  SetpointTable setpoints_;
  SignalTable signals_;
  std::unique_ptr<ControlObject> object_;
};

inline PluginInstance& plugin_instance(void* object) noexcept { return *static_cast<PluginInstance*>(object); }

// False when `work` threw; then `error` says why.
template <typename Work>
bool without_exception(PluginError& error, Work&& work) noexcept {
  try {
    work();
    return true;
  } catch (const std::exception& exception) {
    std::snprintf(error.text, sizeof error.text, "%s", exception.what());
  } catch (...) {
    std::snprintf(error.text, sizeof error.text, "it threw something that is no std::exception");
  }
  return false;
}

template <PluginInstance::Make make>
void* plugin_create(const PluginSetup* setup, PluginError* error) noexcept {
  PluginInstance* made = nullptr;
  without_exception(*error, [&] { made = std::make_unique<PluginInstance>(*setup, make).release(); });
  return made;
}

template <PluginInstance::Make make>
PluginType plugin_type(const char* name) noexcept {
  return {
      .name = name,
      .create = plugin_create<make>,
      .destroy = [](void* o) { const std::unique_ptr<PluginInstance> owned(&plugin_instance(o)); },
      .declare = [](void* o, const PluginDeclaration* program, PluginError* error) -> std::int32_t {
        return without_exception(*error, [&] { plugin_instance(o).declare(*program); }) ? 1 : 0;
      },
      .start = [](void* o, const PluginInput* input) { plugin_instance(o).start(*input); },
      .step = [](void* o, const PluginInput* input,
                 ActuationFrame* actuation) { plugin_instance(o).step(*input, *actuation); },
      .set_parameter = [](void* o, std::uint32_t number,
                          double value) { plugin_instance(o).set_parameter(number, value); },
      .parameters_changed = [](void* o) { plugin_instance(o).object().parameters_changed(); },
      .set_point = [](void* o, std::uint32_t channel, double value,
                      double duration_s) { plugin_instance(o).object().set_point(channel, value, duration_s); },
      .cancel_motion = [](void* o, std::uint32_t channel) { plugin_instance(o).object().cancel_motion(channel); },
      .motion_remaining_s = [](void* o) { return plugin_instance(o).object().motion_remaining_s(); },
      .read_signals = [](void* o, double* values) { plugin_instance(o).read_signals(values); },
      .update = [](void* o, const Snapshot* snapshot) { plugin_instance(o).object().update(*snapshot); },
  };
}

}  // namespace kadans

#define KADANS_PLUGIN(...)                                                                    \
  extern "C" __attribute__((visibility("default"))) const ::kadans::Plugin* kadans_plugin() { \
    static const ::kadans::PluginType types[] = {__VA_ARGS__};                                \
    static const ::kadans::Plugin plugin = [] {                                               \
      ::kadans::Plugin filled = ::kadans::plugin_sizes();                                     \
      filled.type_count = static_cast<std::uint32_t>(std::size(types));                       \
      filled.types = types;                                                                   \
      return filled;                                                                          \
    }();                                                                                      \
    return &plugin;                                                                           \
  }
