// The seam to plug-ins: control objects in a shared library that was built apart from the program, perhaps by another
// compiler. Only plain data and C functions cross it; the frames are those of kadans/signal, whose layout is fixed. A
// plug-in exports one function:
//
//   extern "C" const kadans::Plugin* kadans_plugin();
//
// Nobody writes these tables by hand: KADANS_PLUGIN (plugin_glue.h) makes them from a ControlObject. The program reads
// them with load_plugin (plugin_library.h).
//
// A change here, or in a frame's layout, needs a new plugin_abi_version. The program compares the version and the sizes
// before it calls anything else.
//
// Threads: update in the behavior thread, the rest as in control_object.h. Strings are valid during the call only.
#pragma once

#include <cstdint>

#include "kadans/signal/frames.h"
#include "kadans/signal/status.h"

namespace kadans {

inline constexpr std::uint32_t plugin_abi_version = 2;

struct PluginLink {
  const char* name;
  double mass_kg;
  double com_m[3];
  double inertia_kg_m2[6];  // xx, yy, zz, xy, xz, yz
};

struct alignas(8) PluginJoint {
  const char* name;
  std::uint32_t type;    // JointType
  std::uint32_t parent;  // a link's number
  std::uint32_t mimics;  // a joint's number, or no_joint
  alignas(8) double position_m[3];
  double orientation[4];  // w, x, y, z
  double axis[3];
  double lower_rad, upper_rad, effort_max_Nm, velocity_max_rad_s, damping_Nms_per_rad, friction_Nm;
  double mimic_multiplier, mimic_offset;
};

struct PluginOption {
  const char* name;
  const char* text;
};

struct PluginSetup {
  void* program;
  void (*asked)(void* program, const char* option);  // the object knows this option, given or not
  const PluginOption* options;                       // as given
  const char* robot;
  const PluginLink* links;
  const PluginJoint* joints;
  const std::uint32_t* driven;  // the joints that the object drives
  std::uint32_t option_count, link_count, joint_count, driven_count;
};

struct alignas(8) PluginInput {
  const JointStates* joints;
  const RobotStatus* status;
  const ActuationFrame* last;
  alignas(8) std::int64_t time_ns;
  double dt_s;
};

// How the plug-in tells the program the parameters, set-points and signals of its object. Each kind is numbered from 0,
// in the order of the calls.
struct PluginDeclaration {
  void* program;
  void (*parameter)(void* program, const char* name, const char* unit, double min, double max, double initial,
                    const char* doc);
  void (*setpoint)(void* program, const char* name, const char* unit, double min, double max, const char* doc,
                   std::uint32_t channel, std::uint32_t joint);
  void (*signal)(void* program, const char* name, const char* unit, const char* doc);
};

struct PluginError {
  char text[512];  // ends with a 0
};

// One type of control object. No function may be missing.
struct PluginType {
  const char* name;
  void* (*create)(const PluginSetup*, PluginError*);  // nullptr: refused, error says why
  void (*destroy)(void* object);
  std::int32_t (*declare)(void* object, const PluginDeclaration*, PluginError*);  // 0: refused, error says why
  void (*start)(void* object, const PluginInput*);
  void (*step)(void* object, const PluginInput*, ActuationFrame*);
  void (*set_parameter)(void* object, std::uint32_t parameter, double value);
  void (*parameters_changed)(void* object);
  void (*set_point)(void* object, std::uint32_t channel, double value, double duration_s);
  void (*cancel_motion)(void* object, std::uint32_t channel);
  double (*motion_remaining_s)(void* object);
  void (*read_signals)(void* object, double* values);  // one value per signal
  void (*update)(void* object, const Snapshot*);
};

struct Plugin {
  std::uint32_t abi_version;
  // sizeof of the types that cross the seam, as the plug-in was compiled.
  std::uint32_t plugin_size, type_size, setup_size, link_size, joint_size, input_size, declaration_size;
  std::uint32_t joint_states_size, robot_status_size, actuation_frame_size, snapshot_size;
  std::uint32_t type_count;
  const PluginType* types;
};

// The first lines of a Plugin, filled as this translation unit was compiled.
constexpr Plugin plugin_sizes() noexcept {
  return {.abi_version = plugin_abi_version,
          .plugin_size = sizeof(Plugin),
          .type_size = sizeof(PluginType),
          .setup_size = sizeof(PluginSetup),
          .link_size = sizeof(PluginLink),
          .joint_size = sizeof(PluginJoint),
          .input_size = sizeof(PluginInput),
          .declaration_size = sizeof(PluginDeclaration),
          .joint_states_size = sizeof(JointStates),
          .robot_status_size = sizeof(RobotStatus),
          .actuation_frame_size = sizeof(ActuationFrame),
          .snapshot_size = sizeof(Snapshot),
          .type_count = 0,
          .types = nullptr};
}

}  // namespace kadans
