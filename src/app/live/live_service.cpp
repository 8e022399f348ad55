#include "live_service.h"

#include <CLI/CLI.hpp>

#include "app/option_checks.h"
#include "app/terminal.h"
#include "config/json/json_value.h"
#include "remote/instance/run_description.h"
#include "remote/page/page_files.h"

namespace kadans {

void add_live_service(CLI::App& command, LiveServiceOptions& place) {
  command
      .add_flag("--live{8765}", place.port,
                "Serve this run to browsers and to viewers such as Foxglove; --live=PORT, 0: any free port")
      ->check(whole_within(0, 65535));
  command.add_option("--live-address", place.address, "Address to listen on (default: this machine alone)")
      ->type_name("IP");
  command.add_option("--live-token", place.token, "Token that a client needs to change anything (default: a new one)")
      ->type_name("TEXT");
  add_live_hosts(command, place);
}

void add_live_hosts(CLI::App& command, LiveServiceOptions& place) {
  command
      .add_option("--live-host", place.hosts,
                  "Another name of this machine, by which clients without the token may reach it")
      ->type_name("NAME")
      ->allow_extra_args(false);
}

ViewerSubjects viewer_subjects(const RobotConfig& robot) {
  ViewerSubjects subjects{.joints = robot.model.joint_names(), .base = robot.model.links.front().name, .feet = {}};
  for (const FootSettings& foot : robot.plant.feet) subjects.feet.push_back(foot.link);
  return subjects;
}

RobotTexts robot_texts(const Assembly& assembly) {
  const RobotConfig& robot = assembly.robot();
  return {.name = robot.model.name,
          .urdf = read_input_file(robot.model.file),
          .description = run_description(robot, assembly.catalog(), assembly.own_host()),
          .subjects = viewer_subjects(robot)};
}

LiveService::LiveService(const LiveServiceOptions& place, Instance& instance, const Assembly& assembly,
                         LivePace* pace) {
  if (!place.wanted()) return;
  if (assembly.own_host() == nullptr)
    throw InputError(
        InputProblem{.file = "--live", .message = "shows behaviors of this process: leave out --behaviors process"});
  hub_ = std::make_unique<LiveHub>(LiveHub::Parts{.instance = instance,
                                                  .port = instance.open_port(),
                                                  .texts = robot_texts(assembly),
                                                  .urdf_file = assembly.robot().model.file,
                                                  .timing = {},
                                                  .pace = pace});
  server_ = std::make_unique<LiveServer>(
      LiveSettings{.address = place.address, .port = place.port_number(), .token = place.token, .hosts = place.hosts},
      hub_.get());
}

void LiveService::start(const std::vector<TimingSource>& timing) {
  if (!server_) return;
  hub_->watch_timing(timing);
  server_->start();
  print_line("live on " + server_->url());
  if (page_files().empty()) print_line(std::string(page_is_missing));
}

void LiveService::stop() noexcept {
  if (server_) server_->stop();
}

}  // namespace kadans
