#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/assembly/assembled_plant.h"
#include "app/assembly/robot.h"
#include "app/author/file_checks.h"
#include "commands.h"
#include "config/json/foreign_json.h"
#include "realtime/machine/machine.h"
#include "terminal.h"

namespace kadans {
namespace {

struct DoctorOptions {
  std::string robot;       // "": of the machine alone
  std::string root = "/";  // root folder of the machine that is examined
  bool json = false;
};

void print_machine(const std::vector<MachineFinding>& findings) {
  const bool color = stdout_takes_color();
  for (const MachineFinding& f : findings) {
    const char* const paint = !color ? "" : f.good ? "\033[32m" : "\033[33;1m";
    std::printf("%s%-4s%s %-21s %s\n", paint, f.good ? "ok" : "poor", color ? "\033[0m" : "", f.topic.c_str(),
                f.is.c_str());
    if (f.good) continue;
    std::printf("       should be           %s\n", f.should.c_str());
    std::printf("       to change it        %s\n", f.how.c_str());
  }
}

void print_json(const std::vector<MachineFinding>& findings, bool good) {
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const MachineFinding& f : findings) {
    all.push_back({{"topic", f.topic}, {"good", f.good}, {"is", f.is}, {"should", f.should}, {"how", f.how}});
  }
  std::puts(json_text(nlohmann::ordered_json{{"good", good}, {"findings", all}}).c_str());
}

int run_doctor(const DoctorOptions& options) {
  std::vector<MachineFinding> findings = examine_machine(options.root, ".");
  if (!options.robot.empty()) {
    require_kind(options.robot, JsonKind::robot);
    const Robot robot = read_robot(options.robot);
    const PlantSite site = plant_site(robot.config, "");
    std::ranges::move(imu::examine(robot.config.serial_imu), std::back_inserter(findings));
    for (const auto& type : robot.config.plant_types)
      std::ranges::move(type->examine(site), std::back_inserter(findings));
  }
  const bool good = std::ranges::all_of(findings, &MachineFinding::good);
  if (options.json) {
    print_json(findings, good);
  } else {
    print_machine(findings);
  }
  return good ? exit_passed : exit_failed;
}

}  // namespace

void add_doctor(CommandLine& line) {
  const auto [doctor, options] =
      line.add<DoctorOptions>("doctor", "Report what keeps this machine from real time", run_doctor);
  doctor->add_option("robot", options.robot, "A robot's configuration (JSON): report on its drives, too")
      ->type_name("FILE");
  doctor->add_option("--root", options.root, "Root folder of the examined system (default: /)")->type_name("FOLDER");
  doctor->add_flag("--json", options.json, "Print one JSON object instead of text");
}

}  // namespace kadans
