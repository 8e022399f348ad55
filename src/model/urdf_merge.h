// Makes a RobotModel from urdfdom's links and joints. Fixed joints disappear; what hung on them moves into the parent.
#pragma once

#include <string>
#include <vector>

#include <urdf_model/model.h>

#include "kadans/model/robot_model.h"

namespace kadans {

// `joint_order`: the joints' names in the order of the document. `urdf_file` is where the meshes' paths start from.
// The model has been checked: a tree, known types, mimics without cycles, mesh files that exist.
RobotModel merge_fixed_joints(const urdf::ModelInterface& dom, const std::vector<std::string>& joint_order,
                              const std::string& urdf_file);

}  // namespace kadans
