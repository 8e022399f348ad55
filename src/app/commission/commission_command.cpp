#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "app/author/file_checks.h"
#include "app/bench/drive_bench.h"
#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "commission.h"
#include "commission_person.h"
#include "config/scenario/based_on.h"
#include "signal/input_file.h"

namespace kadans {
namespace {

struct CommissionOptions {
  std::string robot;
  std::string plant;  // "": the only type with wiring that the robot's configuration has
  std::string peer;   // address of the drives; "": the robot's own
  double share = 0.1;
  std::vector<std::string> steps;  // none: all
  std::vector<std::string> joints;
  std::string answers;  // file of lines; "": the terminal, or lines of the standard input
  bool again = false;
};

// The only type of plant with wiring that the robot's configuration describes.
std::string wired_plant(const std::string& file) {
  const Robot robot = read_robot(file);
  const JsonValue json = parse_based_json(read_input_file(file), file).value;
  const JsonMember* const plant = json.find("plant");
  std::vector<std::string> types;
  for (const auto& type : robot.config.plant_types) {
    if (type->wiring() != nullptr && plant != nullptr && plant->value.find(type->name()) != nullptr)
      types.emplace_back(type->name());
  }
  if (types.size() == 1) return types.front();
  refuse(file, types.empty() ? "describes no drives on a bus, such as plant.hm2-eth "
                               "(docs/hostmot2.md) or plant.dynamixel (docs/dynamixel.md)"
                             : "describes drives on several buses: --plant says which");
}

int run_commission(const CommissionOptions& options) {
  require_kind(options.robot, JsonKind::robot);
  const CommissionSettings settings{.robot = options.robot,
                                    .plant = options.plant.empty() ? wired_plant(options.robot) : options.plant,
                                    .share = options.share,
                                    .steps = options.steps,
                                    .joints = options.joints,
                                    .again = options.again};
  catch_interrupts();
  std::unique_ptr<Person> person;
  if (options.answers.empty() && isatty(STDIN_FILENO) == 1) {
    person = std::make_unique<TerminalPerson>();
  } else {
    person = std::make_unique<WrittenPerson>(options.answers);
  }
  const OpenDrives open = [&](const Robot& robot) {
    auto bench = std::make_unique<DriveBench>(robot, settings.plant, options.peer, "");
    return bench->open() ? std::move(bench) : nullptr;
  };
  const CommissionReport report = commission(settings, *person, open);
  for (const std::string& problem : report.problems) print_error(problem);
  if (report.ended_early || !report.problems.empty()) {
    person->hear("Not done yet. The same command goes on where it was.");
    return report.problems.empty() && interrupted() ? exit_interrupted : exit_failed;
  }
  person->hear("All is done.");
  return exit_passed;
}

}  // namespace

void add_commission(CommandLine& line) {
  const auto [command, options] = line.add<CommissionOptions>(
      "commission",
      "Find out which drive is which joint, its signs, zero, limits, scale and gains, and write them down",
      run_commission);
  command->add_option("robot", options.robot, "The robot's configuration (JSON); what is found is written into it")
      ->required()
      ->type_name("FILE");
  command->add_option("joints", options.joints, "Only these joints (default: all that have a motor)")
      ->type_name("NAME");
  command->add_option("--plant", options.plant, "How its drives are reached (default: what the configuration has)")
      ->type_name("TYPE");
  command->add_option("--peer", options.peer, "Address of the drives (default: the configuration's)")
      ->type_name("HOST:PORT");
  add_number(*command, "--share", options.share, 0.001, 0.5, "X",
             "No joint ever gets more than this share of its torque (default: 0.1)");
  command->add_option("--steps", options.steps, "Only these steps, as in names,direction (default: all)")
      ->type_name("LIST")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->check(CLI::IsMember(commission_steps()));
  command->add_flag("--again", options.again, "Forget what was done, and begin anew");
  command->add_option("--answers", options.answers, "Answers from this file, a line each, instead of the terminal")
      ->type_name("FILE");
}

}  // namespace kadans
