// The control objects of a configuration with their tables, as the program makes them.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "config/robot/robot_config.h"
#include "control/balance/dcm_balance.h"
#include "control/balance/stance.h"
#include "control/made_objects.h"
#include "control/walk/dcm_walk.h"
#include "control/walk/stance_leg.h"

namespace kadans {

struct ControlObjects {
  Catalog catalog;
  std::vector<std::unique_ptr<ControlObject>> owners;

  explicit ControlObjects(const RobotConfig& config) {
    for (const ObjectConfig& object : config.objects) {
      ObjectInfo& info = catalog.objects.emplace_back();
      info.name = object.name;
      std::map<std::string, std::string> options;
      for (const TextEntry& option : object.options) options[option.key] = option.text;
      const ObjectSetup setup{config.model, object.joints, options};
      const std::string& type = object.type.name;
      owners.push_back(type == "joint_pid"         ? make_joint_pid(setup)
                       : type == "stance"          ? make_stance(setup)
                       : type == "dcm_walk"        ? make_dcm_walk(setup)
                       : type == "stance_leg"      ? make_stance_leg(setup)
                       : type == "joint_impedance" ? make_joint_impedance(setup)
                                                   : make_dcm_balance(setup));
      const auto first = static_cast<ParameterId>(catalog.parameters.size());
      Declaration declaration(object.name, 0, catalog.parameters, catalog.setpoints, catalog.signals);
      owners.back()->declare(declaration);
      for (ParameterId id = first; id < catalog.parameters.size(); ++id) info.parameters.push_back(id);
    }
  }
  double value(const char* name) const { return catalog.parameters.get(catalog.parameters.find(name).value()); }
};

}  // namespace kadans
