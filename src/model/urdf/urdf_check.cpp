// How the parts of a URDF fit together: the tree, the mimics, the meshes.
#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kadans/signal/nearest_name.h"
#include "urdf_description.h"

namespace kadans {
namespace {

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
    if (sound_) check_masses(document_, robot_);
  }

 private:
  void refuse(std::size_t at, std::string message, std::string_view kind = {}) {
    sound_ = false;
    document_.refuse(at, std::move(message), kind);
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
                               ": a URDF is a tree, so leave out the joint that closes the loop");
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

// Meshes that are not there are left out, and told: of a robot from anybody they are often elsewhere.
class MeshFiles {
 public:
  MeshFiles(UrdfDocument& document, const UrdfOptions& options) : document_(document), options_(options) {}

  void find(std::vector<UrdfGeometry>& all, const char* holder, const std::string& link, const char* consequence) {
    std::erase_if(all, [&](UrdfGeometry& given) {
      auto* const mesh = std::get_if<Mesh>(&given.geometry.shape);
      if (mesh == nullptr) return false;
      if (const std::string& file = found(mesh->file); !file.empty()) {
        mesh->file = file;
        return false;
      }
      document_.warn(given.file_at,
                     "mesh file " + shown_path_quoted(mesh->file) + " is not there: link " + shown_quoted(link) + " " +
                         consequence + where(mesh->file),
                     std::string(holder) + scheme(mesh->file) + package(mesh->file));
      return true;
    });
  }

  // Gives meshes the corners of their hulls. One that cannot be read is left out as one that is not there. What a robot
  // of many equal meshes has is read once.
  void read_hulls(std::vector<UrdfGeometry>& all, const std::string& link) {
    if (!options_.mesh_hull) return;
    std::erase_if(all, [&](UrdfGeometry& given) {
      auto* const mesh = std::get_if<Mesh>(&given.geometry.shape);
      if (mesh == nullptr) return false;
      try {
        const auto [hull, added] = hulls_.try_emplace(mesh->file);
        if (added) hull->second = options_.mesh_hull(mesh->file);
        for (Vec3 corner : hull->second) {
          for (std::size_t i = 0; i < 3; ++i) corner[i] *= mesh->scale[i];
          mesh->corners_m.push_back(corner);
        }
        return false;
      } catch (const InputError& error) {
        hulls_.erase(mesh->file);
        document_.warn(given.file_at,
                       "mesh file " + shown_path_quoted(mesh->file) + " " + error.problems().front().message +
                           "; link " + shown_quoted(link) + " collides without it",
                       "mesh that cannot be read");
        return true;
      }
    });
  }

 private:
  const std::string& found(const std::string& name) {
    const auto [at, added] = found_.emplace(name, "");
    if (added) at->second = find_urdf_file(name, document_.file(), options_.packages).value_or("");
    return at->second;
  }

  static std::string scheme(const std::string& name) {
    const std::size_t end = name.find("://");
    return end == std::string::npos ? "" : name.substr(0, end + 3);
  }

  static std::string package(const std::string& name) {
    const auto path = urdf_package_path(name);
    return path ? path->package : "";
  }

  std::string where(const std::string& name) const {
    if (const std::string of = package(name); !of.empty()) {
      const auto folder = find_urdf_package(of, document_.file(), options_.packages);
      if (folder)
        return "; package " + shown_quoted(of) + " is at " + shown_path_quoted(*folder) + " and has no such file";
      return "; --package " + shown(of) + "=FOLDER or ROS_PACKAGE_PATH says where the package is";
    }
    if (!scheme(name).empty() && !urdf_package_path(name)) return "";
    return std::string(scheme(name).empty() ? "; its" : "; it names no package, so its") +
           " path starts from this file's folder";
  }

  UrdfDocument& document_;
  const UrdfOptions& options_;
  std::map<std::string, std::string> found_;
  std::map<std::string, std::vector<Vec3>> hulls_;  // by file
};

}  // namespace

void check_description(UrdfDocument& document, UrdfDescription& robot, const UrdfOptions& options) {
  MeshFiles files(document, options);
  for (UrdfLink& link : robot.links) {
    files.find(link.collisions, "collision ", link.name, "collides without it");
    files.read_hulls(link.collisions, link.name);
    files.find(link.visuals, "visual ", link.name, "is drawn with a marker in its place");
  }
  TreeCheck(document, robot).run();
}

}  // namespace kadans
