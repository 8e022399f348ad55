#include "commission.h"

#include <algorithm>
#include <array>

#include "app/assembly/assembled_plant.h"
#include "commission_steps.h"
#include "kadans/signal/nearest_name.h"

namespace kadans {
namespace {

struct StepEntry {
  const char* name;
  void (*run)(CommissionStep&);
  bool by_drives = false;  // it pushes drives; the others joints, though two drives move two of them
};
constexpr StepEntry step_entries[] = {{"names", find_names, true}, {"direction", find_directions, true},
                                      {"zero", find_zeros},        {"limits", find_limits},
                                      {"scale", find_scales},      {"gains", find_gains}};

// The joints that have a motor, of those that were asked for.
std::vector<std::size_t> joints_of(const RobotConfig& robot, const std::vector<std::string>& wanted) {
  const std::vector<std::string> names = robot.model.joint_names();
  std::vector<std::size_t> joints;
  for (const std::string& name : wanted) {
    if (std::ranges::find(names, name) == names.end())
      refuse(robot.file, "the robot has no joint '" + name + "'" + did_you_mean(name, names));
  }
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (robot.model.joints[i].passive()) continue;
    if (wanted.empty() || std::ranges::find(wanted, names[i]) != wanted.end()) joints.push_back(i);
  }
  if (joints.empty()) refuse(robot.file, "none of these joints has a motor");
  return joints;
}

// Opens the drives and does one step. False: the program shall end.
bool run_step(const StepEntry& entry, const CommissionSettings& settings, Person& person, const OpenDrives& open,
              Progress& progress, CommissionReport& report) {
  const Robot robot = read_robot(settings.robot);
  const PlantType& type = plant_type_named(robot.config, "--plant", {settings.plant, {}});
  Wiring wiring(type, robot.config.model, settings.robot);
  std::vector<std::size_t> joints = joints_of(robot.config, settings.joints);
  std::erase_if(joints, [&](std::size_t j) { return progress.done(entry.name, robot.config.model.joints[j].name); });
  if (joints.empty()) return true;
  person.hear("== " + std::string(entry.name));
  const std::unique_ptr<Bench> bench = open(robot);
  if (!bench) return false;
  std::vector<double> drive_effort_max_Nm;
  for (const DriveSettings& drive : robot.config.plant.drives) drive_effort_max_Nm.push_back(drive.torque_max_Nm);
  BenchSession session(*bench, person, robot.config.model,
                       {.share = settings.share,
                        .period_s = robot.config.engine.control_period_s,
                        .words = type.drive_words(),
                        .drive_effort_max_Nm = drive_effort_max_Nm});
  if (entry.by_drives) session.by_drives();
  CommissionStep step{session, robot, robot.config, wiring, progress, entry.name, joints, report.problems};
  entry.run(step);
  return true;
}

}  // namespace

const std::vector<std::string>& commission_steps() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const StepEntry& entry : step_entries) all.emplace_back(entry.name);
    return all;
  }();
  return names;
}

CommissionReport commission(const CommissionSettings& settings, Person& person, const OpenDrives& open) {
  CommissionReport report;
  Progress progress(settings.robot, settings.plant, settings.again);
  try {
    for (const StepEntry& entry : step_entries) {
      if (!settings.steps.empty() && std::ranges::find(settings.steps, entry.name) == settings.steps.end()) continue;
      report.ended_early = !run_step(entry, settings, person, open, progress, report);
      // What a step could not find, the later ones need.
      if (report.ended_early || !report.problems.empty()) break;
    }
  } catch (const PersonGone&) {
    report.ended_early = true;
  }
  return report;
}

}  // namespace kadans
