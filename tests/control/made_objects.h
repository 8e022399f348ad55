// The shipped types of control objects. The source of each type defines its make_TYPE.
#pragma once

#include <memory>

#include "kadans/control/control_object.h"

namespace kadans {

std::unique_ptr<ControlObject> make_joint_pid(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_joint_cascade(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_joint_impedance(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_joint_integrator(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_joint_velocity(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_profile_position(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_feedforward_player(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_computed_torque(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_gravity_compensation(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_task_impedance(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_gaze(const ObjectSetup& setup);
std::unique_ptr<ControlObject> make_whole_body(const ObjectSetup& setup);

}  // namespace kadans
