#include "urdf_outline.h"

#include <algorithm>

#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

using tinyxml2::XMLElement;

constexpr std::size_t most = 1000;  // of links and of joints, fixed ones included

std::string child_attribute(const XMLElement& element, const char* child, const char* attribute) {
  const XMLElement* found = element.FirstChildElement(child);
  return found == nullptr ? "" : attribute_or_empty(*found, attribute);
}

template <typename Item>
const Item* find_named(const std::vector<Item>& items, std::string_view name) {
  const auto found = std::find_if(items.begin(), items.end(), [&](const Item& item) { return item.name == name; });
  return found == items.end() ? nullptr : &*found;
}

void check_count(UrdfDocument& document, std::size_t count, const XMLElement& element, const char* what) {
  if (count <= most) return;
  document.refuse(element, "more than " + std::to_string(most) + " " + what);
  document.throw_if_refused();
}

}  // namespace

const UrdfLink* UrdfOutline::find_link(std::string_view name) const { return find_named(links, name); }
const UrdfJoint* UrdfOutline::find_joint(std::string_view name) const { return find_named(joints, name); }
std::vector<std::string> UrdfOutline::link_names() const { return names_of(links); }
std::vector<std::string> UrdfOutline::joint_names() const { return names_of(joints); }

UrdfOutline outline_of(UrdfDocument& document) {
  UrdfOutline outline;
  const XMLElement& robot = document.robot();
  for (const XMLElement* e = robot.FirstChildElement("link"); e != nullptr; e = e->NextSiblingElement("link")) {
    outline.links.push_back({attribute_or_empty(*e, "name"), e, e->FirstChildElement("inertial") != nullptr});
    check_count(document, outline.links.size(), *e, "links");
  }
  for (const XMLElement* e = robot.FirstChildElement("joint"); e != nullptr; e = e->NextSiblingElement("joint")) {
    outline.joints.push_back({attribute_or_empty(*e, "name"), attribute_or_empty(*e, "type"),
                              child_attribute(*e, "parent", "link"), child_attribute(*e, "child", "link"), e,
                              e->FirstChildElement("mimic")});
    check_count(document, outline.joints.size(), *e, "joints");
  }
  if (outline.links.empty()) {
    document.refuse(robot, "this robot has no <link>");
    document.throw_if_refused();
  }
  return outline;
}

}  // namespace kadans
