// What the control layer offers to the other layers, by name: objects, control sets, poses, presets and the tables. It
// is made before the loop and never changed afterwards, so any thread may read it. Scripts, viewers and `check` need
// nothing else.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "kadans/control/composition.h"
#include "kadans/control/switchover.h"
#include "kadans/model/robot_model.h"
#include "kadans/signal/parameter.h"
#include "kadans/signal/seen_info.h"
#include "kadans/signal/sensor_channel.h"
#include "kadans/signal/setpoint.h"
#include "kadans/signal/signal.h"
#include "kadans/signal/status.h"

namespace kadans {

class Foresight;

// Named values for some of an object's parameters: gains "soft", gains "stiff".
struct Preset {
  std::string name;
  std::vector<std::pair<ParameterId, double>> values;
};

struct ObjectInfo {
  std::string name;
  std::string type;
  std::vector<std::size_t> joints;
  std::vector<ParameterId> parameters;
  std::vector<SetpointId> setpoints;
  std::vector<Preset> presets;
  std::uint32_t divisor = 1;             // low level every n-th control tick
  std::uint32_t high_level_divisor = 1;  // high level every n-th behavior tick
  double switch_dwell_s = 0;             // least time between two switches of it (switch_dwell.h)
  Foresight* foresight = nullptr;        // what it can say about reach (control_object.h); behavior thread
};

struct ControlSetInfo {
  std::string name;
  std::vector<std::uint32_t> objects;       // in the order of computing
  std::vector<Composition> compositions{};  // one per object; empty: every object sets its joints
  double switch_dwell_s = 0;                // least time between two switches of it (switch_dwell.h)
};

inline constexpr double switch_dwell_max_s = 60;

// A named posture that a behavior can move to: positions for some joints.
struct PoseInfo {
  std::string name;
  std::vector<std::pair<std::size_t, double>> position_rad;  // joint index, position
};

// What a joint does while no active control set holds it: a spring and a damper draw it back to where it was let go.
// Both 0: the joint is off.
struct UnheldLaw {
  double stiffness_Nm_per_rad = 0;
  double damping_Nms_per_rad = 0;
};

// The first value of a behavior's parameter on this robot, as its configuration gives it.
struct BehaviorValue {
  std::string behavior, parameter;
  double value = 0;
  std::string chunk{};  // the behavior's file, from the project root
  std::string file{};   // the configuration that gives it
  int line = 0, column = 0;
};

// A sole as behaviors know it: `s.feet.NAME`, and "foot.NAME.contact" in conditions. Its signals are named by its link.
struct FootInfo {
  std::string name, link;
};

struct Catalog {
  const RobotModel* model = nullptr;
  ParameterTable parameters;
  SetpointTable setpoints;
  SignalTable signals;
  std::vector<ObjectInfo> objects;
  std::vector<ControlSetInfo> sets;
  std::vector<PoseInfo> poses;
  SetMask initial_sets = 1;
  std::vector<std::uint32_t> at_drives;  // the actuator-level objects, which are in no set (control_sets.h)
  std::vector<DriveLaw> drives;          // one per joint; empty: switching is not smoothed
  SwitchSettings switching;
  std::vector<UnheldLaw> unheld;  // one per joint; empty: off
  std::vector<BehaviorValue> behavior_values;
  std::vector<FootInfo> feet;          // in the order of the frames
  std::vector<SeenInfo> seen{};        // entries of the world model, in the order of the snapshot
  std::vector<SensorChannel> sensors;  // other than joints, IMU and feet; in the order of the frames
};

}  // namespace kadans
