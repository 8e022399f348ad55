#include "new_subject.h"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>

#include "app/author/behavior_stage.h"
#include "config/robot/project_root.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;

// The mass that each joint carries, and whether a foot hangs on it.
struct CarriedLoad {
  std::vector<double> kg;
  std::vector<bool> foot;
};

CarriedLoad carried_by(const RobotModel& model, const std::vector<FootSettings>& feet, bool stands) {
  CarriedLoad found{std::vector<double>(model.joints.size()),
                    std::vector<bool>(model.joints.size(), stands && feet.empty())};
  for (const FootSettings& foot : feet) {
    const auto link = model.find_link(foot.link);
    if (link && *link > 0) found.foot[*link - 1] = true;
  }
  for (std::size_t i = model.joints.size(); i-- > 0;) {  // parents come before children
    found.kg[i] += model.links[i + 1].inertia.mass_kg;
    if (model.joints[i].parent == 0) continue;
    const std::size_t before = model.joints[i].parent - 1;
    found.kg[before] += found.kg[i];
    if (found.foot[i]) found.foot[before] = true;
  }
  return found;
}

double down_to(double value, double unit) { return std::floor(value / unit + 1e-9) * unit; }

// The object and the set of it that leads the most joints; sets of the start first.
void choose_object(const Catalog& catalog, AsideJoint& found) {
  std::size_t most = 0;
  for (std::size_t i = 0; i < catalog.sets.size(); ++i) {
    for (const std::uint32_t number : catalog.sets[i].objects) {
      const ObjectInfo& object = catalog.objects[number];
      auto led = static_cast<std::size_t>(std::ranges::count_if(object.setpoints, [&](SetpointId id) {
        return catalog.setpoints[id].joint != no_joint && catalog.setpoints[id].name.ends_with(".position_rad");
      }));
      if (led == 0) continue;
      if ((catalog.initial_sets >> i & 1) != 0) led += max_joints;
      if (led <= most) continue;
      most = led;
      found.set = &catalog.sets[i];
      found.object = &object;
    }
  }
}

}  // namespace

fs::path folder_of(const NewPartOptions& options) {
  return options.folder.empty() ? fs::current_path() : fs::path(options.folder);
}

fs::path file_named(const fs::path& name, const fs::path& folder) {
  std::error_code unknown;
  return !fs::exists(name, unknown) && fs::exists(folder / name, unknown) ? folder / name : name;
}

NewSubject read_subject(const NewPartOptions& options) {
  const fs::path here = folder_of(options);
  const fs::path file = options.robot.empty() ? only_robot(here, "--robot FILE") : file_named(options.robot, here);
  NewSubject subject;
  subject.robot = read_robot(file);
  subject.project = project_root(file);
  subject.robot_file = fs::proximate(fs::weakly_canonical(file), fs::weakly_canonical(subject.project)).string();
  const fs::path named = fs::weakly_canonical(fs::absolute(here)), root = fs::weakly_canonical(subject.project);
  const bool outside = subject.robot_file.starts_with("..") ||
                       (!options.folder.empty() && named.lexically_relative(root).string().starts_with(".."));
  if (outside) {
    refuse(file, "lies in another project than " + here.string() +
                     "; a project has its robots in config/NAME/robot.json, and a folder models or "
                     "behaviors: `kadans new robot` makes one");
  }
  subject.system = make_control_system(subject.robot);
  return subject;
}

AsideJoint joint_aside(const NewSubject& subject) {
  const Catalog& catalog = subject.system->catalog;
  const RobotModel& model = subject.model();
  const PlantSettings& plant = subject.robot.config.plant;
  AsideJoint found;
  choose_object(catalog, found);
  const CarriedLoad carried = carried_by(model, plant.feet, subject.stands());
  std::size_t best = model.joints.size();
  double room_most = 0, home = 0;
  bool upwards = true;
  if (found.object != nullptr) {
    for (const SetpointId id : found.object->setpoints) {
      const Setpoint& setpoint = catalog.setpoints[id];
      if (setpoint.joint >= model.joints.size() || !setpoint.name.ends_with(".position_rad")) continue;
      const std::size_t i = setpoint.joint;
      const double at = i < plant.position_rad.size() ? plant.position_rad[i] : 0;
      const double above = setpoint.max - at, below = at - setpoint.min, room = std::max(above, below);
      if (model.joints[i].mimic || model.joints[i].passive() || room < 0.02) continue;
      const bool better = best == model.joints.size() || (carried.foot[best] && !carried.foot[i]) ||
                          (carried.foot[best] == carried.foot[i] && carried.kg[i] < carried.kg[best]);
      if (!better) continue;
      best = i;
      room_most = room;
      upwards = above >= below;
      home = at;
    }
  }
  if (best == model.joints.size())
    refuse(subject.file(),
           "no control set of it has an object that leads a joint by its position "
           "(docs/control.md), so there is nothing that a first behavior could move");
  const bool slider = model.joints[best].type == JointType::prismatic;
  const double wanted = (slider ? 0.1 : 1) * (carried.foot[best] ? 0.05 : 0.3);
  found.joint = &model.joints[best];
  found.most = down_to(std::min(room_most, slider ? 10 : 3.1), 0.001);
  found.aside = std::min(wanted, down_to(0.5 * found.most, 0.001)) * (upwards ? 1 : -1);
  found.home = home;
  return found;
}

void add_part_options(CLI::App& command, NewPartOptions& options, const char* name, const char* not_run) {
  command.add_option("name", options.name, name)->required()->type_name("NAME");
  command.add_option("--robot", options.robot, "The robot's configuration (default: the project's only one)")
      ->type_name("FILE");
  command.add_option("--in", options.folder, "Project to which its files are added (default: the robot's)")
      ->type_name("FOLDER");
  command.add_flag("--no-run", options.no_run, not_run);
}

}  // namespace kadans
