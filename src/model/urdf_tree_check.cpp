#include <map>
#include <set>

#include "kadans/signal/nearest_name.h"
#include "urdf_checks.h"

namespace kadans {
namespace {

using tinyxml2::XMLElement;

class TreeCheck {
 public:
  TreeCheck(UrdfDocument& document, const UrdfOutline& outline) : document_(document), outline_(outline) {}

  void run() {
    check_twice(outline_.links, "link");
    check_twice(outline_.joints, "joint");
    for (const UrdfJoint& joint : outline_.joints) {
      check_end(joint, "parent", joint.parent);
      check_end(joint, "child", joint.child);
      hang(joint);
    }
    if (!sound_) return;  // what follows would be consequences
    check_roots();
    if (sound_) check_masses();
  }

 private:
  std::string in_line(const XMLElement* element) const { return "line " + std::to_string(document_.line(*element)); }

  template <typename Item>
  void check_twice(const std::vector<Item>& items, const char* what) {
    std::map<std::string, const Item*> first;
    for (const Item& item : items) {
      if (item.name.empty()) sound_ = false;
      if (item.name.empty() || first.emplace(item.name, &item).second) continue;
      sound_ = false;
      document_.refuse_value(*item.element, "name",
                             std::string(what) + " " + quoted(item.name) + " is defined twice, first in " +
                                 in_line(first[item.name]->element));
    }
  }

  void check_end(const UrdfJoint& joint, const char* end, const std::string& link) {
    if (!link.empty() && outline_.find_link(link) != nullptr) return;
    sound_ = false;
    const XMLElement* element = joint.element->FirstChildElement(end);
    if (link.empty() || element == nullptr) return;  // the grammar has said so
    document_.refuse_value(*element, "link",
                           std::string(end) + " link " + quoted(link) + " of joint " + quoted(joint.name) +
                               " does not exist" + did_you_mean(link, outline_.link_names()));
  }

  void hang(const UrdfJoint& joint) {
    const XMLElement* element = joint.element->FirstChildElement("child");
    if (joint.child.empty() || element == nullptr) return;
    if (joint.child == joint.parent) {
      sound_ = false;
      return document_.refuse(*joint.element,
                              "joint " + quoted(joint.name) + " joins link " + quoted(joint.child) + " to itself");
    }
    const auto [other, is_new] = above_.emplace(joint.child, &joint);
    if (is_new) return;
    sound_ = false;
    document_.refuse_value(*element, "link",
                           "link " + quoted(joint.child) + " hangs on two joints, " + quoted(other->second->name) +
                               " (" + in_line(other->second->element) + ") and " + quoted(joint.name) +
                               ": a URDF is a tree");
  }

  void check_roots() {
    const UrdfLink* root = nullptr;
    for (const UrdfLink& link : outline_.links) {
      if (above_.contains(link.name)) continue;
      if (root != nullptr) {
        sound_ = false;
        document_.refuse(*link.element, "two roots: link " + quoted(link.name) + " hangs on no joint, nor does link " +
                                            quoted(root->name) + " (" + in_line(root->element) + ")");
      }
      if (root == nullptr) root = &link;
    }
    check_loops();
  }

  // Upwards from every link: who does not end at a root runs in a circle. Each link is walked over once.
  void check_loops() {
    std::set<std::string> done;
    for (const UrdfLink& link : outline_.links) {
      std::set<std::string> path;
      std::string at = link.name;
      while (above_.contains(at) && !done.contains(at) && path.insert(at).second) at = above_.at(at)->parent;
      if (path.contains(at) && !done.contains(at)) refuse_loop(at);
      done.insert(path.begin(), path.end());
    }
  }

  void refuse_loop(const std::string& start) {
    constexpr std::size_t most_shown = 8;
    sound_ = false;
    std::vector<std::string> names{shown(start)};  // upwards
    for (std::string at = above_.at(start)->parent; at != start; at = above_.at(at)->parent) names.push_back(shown(at));
    std::string text = shown(start);
    for (std::size_t i = names.size(); i-- > 0;) {
      if (i < most_shown) text.append(" -> ").append(names[i]);
      if (i == most_shown) text.append(" -> ...");
    }
    document_.refuse(*above_.at(start)->element, "joints in a loop: " + text + "; a URDF is a tree with one root");
  }

  // A body is a link with all that is fixed to it. The root may be without mass: a base that is bolted to the world.
  void check_masses() {
    std::set<std::string> heavy;  // links at the top of a body that has mass
    for (const UrdfLink& link : outline_.links) {
      if (link.has_mass) heavy.insert(top_of_body(link.name));
    }
    for (const UrdfJoint& joint : outline_.joints) {
      if (!joint.moves() || heavy.contains(joint.child)) continue;
      document_.refuse(*outline_.find_link(joint.child)->element,
                       "link " + quoted(joint.child) + " moves on joint " + quoted(joint.name) +
                           " but has no mass: it, or a link fixed to it, needs an <inertial>");
    }
  }

  std::string top_of_body(std::string at) const {
    for (auto joint = above_.find(at); joint != above_.end() && !joint->second->moves(); joint = above_.find(at)) {
      at = joint->second->parent;
    }
    return at;
  }

  UrdfDocument& document_;
  const UrdfOutline& outline_;
  std::map<std::string, const UrdfJoint*> above_;  // child link -> its joint
  bool sound_ = true;
};

}  // namespace

void check_tree(UrdfDocument& document, const UrdfOutline& outline) { TreeCheck(document, outline).run(); }

}  // namespace kadans
