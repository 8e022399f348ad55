// The names in a URDF, and which link hangs on which: the checks of links, joints and tree look at this.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "urdf_document.h"

namespace kadans {

struct UrdfLink {
  std::string name;
  const tinyxml2::XMLElement* element = nullptr;
  bool has_mass = false;
};

struct UrdfJoint {
  std::string name, type, parent, child;
  const tinyxml2::XMLElement* element = nullptr;
  const tinyxml2::XMLElement* mimic = nullptr;  // its <mimic>, if it has one

  bool moves() const noexcept { return type != "fixed"; }
};

struct UrdfOutline {
  std::vector<UrdfLink> links;    // in the order of the document
  std::vector<UrdfJoint> joints;  // in the order of the document

  const UrdfLink* find_link(std::string_view name) const;    // the first of this name
  const UrdfJoint* find_joint(std::string_view name) const;  // the first of this name
  std::vector<std::string> link_names() const;
  std::vector<std::string> joint_names() const;
};

// Throws when there are no links or more than 1000 links or joints. Names that are missing are "".
UrdfOutline outline_of(UrdfDocument& document);

}  // namespace kadans
