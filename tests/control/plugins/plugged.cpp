// The shipped control objects, made by a plug-in. CMakeLists.txt lets tests call plugged_joint_pid where they are
// written with make_joint_pid.
#include "control/plugin_library.h"

namespace kadans {
namespace {

std::unique_ptr<ControlObject> made(const char* type, const ObjectSetup& setup) {
  static const ControlObjectTypes types = [] {
    ControlObjectTypes loaded;
    std::vector<MakePlantType> plants;
    load_plugin(KADANS_BINARY_DIR "/tests/plugins/shipped_plugin.so", loaded, plants);
    return loaded;
  }();
  return (*types.find(type))(setup);
}

}  // namespace

#define PLUGGED(type) \
  std::unique_ptr<ControlObject> plugged_##type(const ObjectSetup& setup) { return made("plugged_" #type, setup); }
PLUGGED(joint_pid)
PLUGGED(joint_cascade)
PLUGGED(joint_impedance)
PLUGGED(joint_integrator)
PLUGGED(joint_velocity)
PLUGGED(trajectory_list)
PLUGGED(profile_position)
PLUGGED(feedforward_player)
PLUGGED(computed_torque)
PLUGGED(gravity_compensation)
PLUGGED(gaze)
PLUGGED(task_impedance)
PLUGGED(whole_body)

}  // namespace kadans
