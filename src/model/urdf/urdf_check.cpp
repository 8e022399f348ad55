// How the parts of a URDF fit together: the tree, the mimics, the meshes.
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "signal/nearest_name.h"
#include "urdf_description.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> if_file(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  return path.lexically_normal().string();
}

std::optional<std::string> in_package(const std::string& rest, const fs::path& start) {
  const std::size_t slash = rest.find('/');
  if (slash == 0 || slash == std::string::npos) return std::nullopt;
  const fs::path package = rest.substr(0, slash), inside = rest.substr(slash + 1);
  for (fs::path folder = start;; folder = folder.parent_path()) {
    if (folder.filename() == package) {
      if (auto found = if_file(folder / inside)) return found;
    }
    if (auto found = if_file(folder / package / inside)) return found;
    if (folder == folder.parent_path()) return std::nullopt;
  }
}

std::optional<std::string> find_mesh(const std::string& name_in_urdf, const std::string& urdf_file) {
  const std::string package = "package://", file = "file://";
  if (name_in_urdf.starts_with(file)) return if_file(name_in_urdf.substr(file.size()));
  std::error_code error;
  const fs::path folder = fs::absolute(fs::path(urdf_file), error).parent_path();
  if (name_in_urdf.starts_with(package)) return in_package(name_in_urdf.substr(package.size()), folder);
  return if_file(folder / name_in_urdf);
}

template <typename Item>
std::map<std::string, const Item*> first_by_name(const std::vector<Item>& items) {
  std::map<std::string, const Item*> first;
  for (const Item& item : items) first.emplace(item.name, &item);
  return first;
}

class TreeCheck {
 public:
  TreeCheck(UrdfDocument& document, const UrdfDescription& robot)
      : document_(document), robot_(robot), links_(first_by_name(robot.links)), joints_(first_by_name(robot.joints)) {}

  void run() {
    check_mimics();
    check_twice(robot_.links, links_, "link");
    check_twice(robot_.joints, joints_, "joint");
    for (const UrdfJoint& joint : robot_.joints) {
      check_end(joint, "parent", joint.parent);
      check_end(joint, "child", joint.child);
      hang(joint);
    }
    if (!sound_) return;  // what follows would be consequences
    check_roots();
    check_loops();
    if (sound_) check_masses();
  }

 private:
  void refuse(std::size_t at, std::string message) {
    sound_ = false;
    document_.refuse(at, std::move(message));
  }

  template <typename Item>
  void check_twice(const std::vector<Item>& items, const std::map<std::string, const Item*>& first, const char* what) {
    for (const Item& item : items) {
      if (item.name.empty()) sound_ = false;  // the reader has said so
      const Item* before = first.at(item.name);
      if (item.name.empty() || before == &item) continue;
      refuse(item.name_at, std::string(what) + " " + shown_quoted(item.name) + " is defined twice, first in " +
                               document_.in_line(before->at));
    }
  }

  void check_end(const UrdfJoint& joint, const char* what, const UrdfEnd& end) {
    if (end.link.empty()) sound_ = false;  // the reader has said so
    if (end.link.empty() || links_.contains(end.link)) return;
    refuse(end.at, std::string(what) + " link " + shown_quoted(end.link) + " of joint " + shown_quoted(joint.name) +
                       " does not exist" + did_you_mean(end.link, names_of(robot_.links)));
  }

  void hang(const UrdfJoint& joint) {
    const std::string& child = joint.child.link;
    if (child.empty()) return;
    if (child == joint.parent.link)
      return refuse(joint.at,
                    "joint " + shown_quoted(joint.name) + " joins link " + shown_quoted(child) + " to itself");
    const UrdfJoint& other = *above_.emplace(child, &joint).first->second;
    if (&other == &joint) return;
    refuse(joint.child.at, "link " + shown_quoted(child) + " hangs on two joints, " + shown_quoted(other.name) + " (" +
                               document_.in_line(other.at) + ") and " + shown_quoted(joint.name) +
                               ": a URDF is a tree");
  }

  void check_roots() {
    const UrdfLink* root = nullptr;
    for (const UrdfLink& link : robot_.links) {
      if (above_.contains(link.name)) continue;
      if (root != nullptr)
        refuse(link.at, "two roots: link " + shown_quoted(link.name) + " hangs on no joint, nor does link " +
                            shown_quoted(root->name) + " (" + document_.in_line(root->at) + ")");
      if (root == nullptr) root = &link;
    }
  }

  // Upwards from every link: who does not end at a root runs in a circle. Each link is walked over once.
  void check_loops() {
    std::set<std::string> done;
    for (const UrdfLink& link : robot_.links) {
      std::set<std::string> path;
      std::string at = link.name;
      while (above_.contains(at) && !done.contains(at) && path.insert(at).second) at = above_.at(at)->parent.link;
      if (path.contains(at) && !done.contains(at)) refuse_loop(at);
      done.insert(path.begin(), path.end());
    }
  }

  void refuse_loop(const std::string& start) {
    constexpr std::size_t most_shown = 8;
    std::vector<std::string> names;  // upwards
    std::string at = start;
    do {
      names.push_back(shown(at));
      at = above_.at(at)->parent.link;
    } while (at != start);
    std::string text = shown(start);
    for (std::size_t i = names.size(); i-- > 0;) {
      if (i < most_shown) text.append(" -> ").append(names[i]);
      if (i == most_shown) text.append(" -> ...");
    }
    refuse(above_.at(start)->at, "joints in a loop: " + text + "; a URDF is a tree with one root");
  }

  // A body is a link with all that is fixed to it. The root may be without mass: a base that is bolted to the world.
  void check_masses() {
    std::set<std::string> heavy;  // links at the top of a body that has mass
    for (const UrdfLink& link : robot_.links) {
      if (!link.inertia) continue;
      std::string at = link.name;
      for (auto up = above_.find(at); up != above_.end() && !up->second->moves; up = above_.find(at))
        at = up->second->parent.link;
      heavy.insert(at);
    }
    for (const UrdfJoint& joint : robot_.joints) {
      if (!joint.moves || heavy.contains(joint.child.link)) continue;
      refuse(links_.at(joint.child.link)->at, "link " + shown_quoted(joint.child.link) + " moves on joint " +
                                                  shown_quoted(joint.name) +
                                                  " but has no mass: it, or a link fixed to it, needs an <inertial>");
    }
  }

  void check_mimics() {
    std::set<std::string> in_rings;
    for (const UrdfJoint& joint : robot_.joints) {
      if (!joint.mimic || joint.mimic->joint.empty()) continue;  // the reader has said so
      const UrdfMimic& mimic = *joint.mimic;
      const UrdfJoint* leader = leader_of(joint);
      const std::string what = "joint " + shown_quoted(joint.name) + " mimics joint " + shown_quoted(mimic.joint);
      if (leader == nullptr) {
        document_.refuse(mimic.joint_at,
                         what + ", which does not exist" + did_you_mean(mimic.joint, names_of(robot_.joints)));
      } else if (!joint.moves) {
        document_.refuse(mimic.at, "joint " + shown_quoted(joint.name) + " is fixed and cannot mimic another");
      } else if (!leader->moves) {
        document_.refuse(mimic.joint_at, what + ", which is fixed");
      } else if (!in_rings.contains(joint.name)) {
        refuse_ring(joint, in_rings);
      }
    }
  }

  const UrdfJoint* leader_of(const UrdfJoint& joint) const {
    const auto found = joint.mimic ? joints_.find(joint.mimic->joint) : joints_.end();
    return found == joints_.end() ? nullptr : found->second;
  }

  // From the joint along its mimics, when they come back to it.
  void refuse_ring(const UrdfJoint& start, std::set<std::string>& in_rings) {
    std::set<std::string> path{start.name};
    std::string text = shown(start.name);
    const UrdfJoint* at = leader_of(start);
    for (; at != nullptr && at != &start && path.insert(at->name).second; at = leader_of(*at))
      text += " -> " + shown(at->name);
    if (at != &start) return;
    in_rings.merge(path);
    document_.refuse(start.mimic->joint_at, "joints mimic each other in a ring: " + text + " -> " + shown(start.name));
  }

  UrdfDocument& document_;
  const UrdfDescription& robot_;
  std::map<std::string, const UrdfLink*> links_;
  std::map<std::string, const UrdfJoint*> joints_;
  std::map<std::string, const UrdfJoint*> above_;  // child link -> its joint
  bool sound_ = true;
};

void find_file(UrdfDocument& document, UrdfGeometry& given) {
  auto* const mesh = std::get_if<Mesh>(&given.geometry.shape);
  if (mesh == nullptr || mesh->file.empty()) return;
  if (const auto found = find_mesh(mesh->file, document.file())) {
    mesh->file = *found;
    return;
  }
  std::string where;
  if (mesh->file.starts_with("package://")) where = ": no folder of this package holds it, from the URDF's folder up";
  if (mesh->file.find("://") == std::string::npos) where = ": its path starts from the URDF's folder";
  document.refuse(given.file_at, "mesh file " + shown_quoted(mesh->file) + " is not there" + where);
}

}  // namespace

void check_description(UrdfDocument& document, UrdfDescription& robot, const UrdfOptions& options) {
  for (UrdfLink& link : robot.links) {
    for (UrdfGeometry& given : link.collisions) {
      if (std::holds_alternative<Mesh>(given.geometry.shape) && !options.mesh_hulls)
        document.refuse(given.mesh_at, "the collision of link " + shown_quoted(link.name) +
                                           " is a mesh, which collides only as its convex hull and only when mesh "
                                           "hulls are asked for: ask, or use <box>, <sphere> or <cylinder>");
      find_file(document, given);
    }
    for (UrdfGeometry& given : link.visuals) find_file(document, given);
  }
  TreeCheck(document, robot).run();
}

}  // namespace kadans
