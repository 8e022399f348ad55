// urdfdom, with all its messages collected: it logs mistakes where it should fail.
#pragma once

#include <string>
#include <vector>

#include <urdf_model/model.h>
#include <urdf_world/types.h>  // the shared pointers' names

namespace kadans {

struct UrdfDom {
  urdf::ModelInterfaceSharedPtr model;  // null when urdfdom gave up
  std::vector<std::string> complaints;  // its errors and warnings; with any of them the model is not to be trusted
};

// console_bridge's handler belongs to the process: calls from several threads wait for each other.
UrdfDom parse_with_urdfdom(const std::string& xml);

}  // namespace kadans
