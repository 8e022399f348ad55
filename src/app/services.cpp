#include "services.h"

#include <cstdlib>

#include <CLI/CLI.hpp>

#include "config/json/json_value.h"
#include "config/robot/project_root.h"
#include "kadans/signal/input_error.h"
#include "option_checks.h"
#include "remote/instance/run_description.h"
#include "remote/page/page_files.h"
#include "signal/number_text.h"
#include "terminal.h"
#include "version.h"

namespace kadans {
namespace {

constexpr int domain_max = 232;  // higher numbers would give invalid ports

void add_ctl_service(CLI::App& command, CtlServiceOptions& place) {
  CLI::Option* folder =
      command
          .add_option("--ctl", place.folder, "Folder in which 'kadans ctl' finds this run (default: see docs/ctl.md)")
          ->type_name("FOLDER");
  command.add_flag("!--no-ctl", place.wanted, "Hide this run from 'kadans ctl'")->excludes(folder);
  command.add_option("--ctl-operators", place.operators, "Group that may operate this run")->type_name("GROUP");
  command
      .add_option("--ctl-developers", place.developers,
                  "Group that may also change parameters and behaviors of this run")
      ->type_name("GROUP");
}

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

void add_ros2_service(CLI::App& command, Ros2Options& place) {
  CLI::Option* ros2 =
      command
          .add_flag("--ros2{-1}", place.domain,
                    "Publish ROS 2 topics on this machine; --ros2=DOMAIN (default: ROS_DOMAIN_ID, else 0)")
          ->check(whole_within(-1, domain_max));
  add_number(command, "--ros2-rate", place.rate_hz, 1.0, 1000.0, "HZ", "Rate of the topics (default: 100)")
      ->needs(ros2);
  command.add_flag("--ros2-commands", place.commands, "Carry out the commands that anybody sends to /kadans/command")
      ->needs(ros2);
}

std::uint32_t domain_of(const Ros2Options& place) {
  if (place.domain != "-1") return static_cast<std::uint32_t>(std::stoul(place.domain));
  const char* const text = std::getenv("ROS_DOMAIN_ID");  // NOLINT(concurrency-mt-unsafe): before any thread
  if (text == nullptr || *text == '\0') return 0;
  const std::optional<int> domain = number_of<int>(text);
  if (!domain || *domain < 0 || *domain > domain_max)
    refuse("ROS_DOMAIN_ID", "'" + std::string(text) + "' must be from 0 to " + std::to_string(domain_max));
  return static_cast<std::uint32_t>(*domain);
}

}  // namespace

void add_live_hosts(CLI::App& command, LiveServiceOptions& place) {
  command
      .add_option("--live-host", place.hosts,
                  "Another name of this machine, by which clients without the token may reach it")
      ->type_name("NAME")
      ->allow_extra_args(false);
}

void add_services(CLI::App& command, ServiceOptions& options) {
  add_ctl_service(command, options.ctl);
  add_live_service(command, options.live);
  add_ros2_service(command, options.ros2);
}

CtlService::CtlService(const CtlServiceOptions& place, Instance& instance) {
  if (!place.wanted) return;
  const bool named = !place.folder.empty();
  try {
    sockets_.emplace(
        CtlSockets::Settings{.folder = named ? std::filesystem::path(place.folder) : ctl_folder_for_server(),
                             .operators = place.operators,
                             .developers = place.developers});
    server_.emplace(instance, *sockets_, CtlServer::Settings{});
  } catch (const InputError& error) {
    if (named) throw;
    print_error(std::string("kadans ctl will not find this run: ") + error.what());
  }
}

void CtlService::start() {
  if (server_) server_->start();
}

void CtlService::stop() noexcept {
  if (server_) server_->stop();
}

ViewerSubjects viewer_subjects(const Assembly& assembly) {
  const RobotConfig& robot = assembly.robot();
  ViewerSubjects subjects{.joints = robot.model.joint_names(), .base = robot.model.links.front().name, .feet = {}};
  for (const FootSettings& foot : robot.plant.feet) subjects.feet.push_back(foot.link);
  for (const auto& other : assembly.others()) {
    subjects.others.push_back(viewer_subjects(*other));
    subjects.others.back().robot = other->scenario().name;
  }
  return subjects;
}

RobotTexts robot_texts(const Assembly& assembly) {
  const RobotConfig& robot = assembly.robot();
  RobotTexts texts{.name = robot.model.name,
                   .urdf = read_input_file(robot.model.file),
                   .description = run_description(robot, assembly.scenario().robot_name, assembly.catalog(),
                                                  assembly.own_host(), assembly.world_settings())};
  for (const auto& other : assembly.others()) {
    const std::string& file = other->robot().model.file;
    texts.others.push_back({.name = other->scenario().name, .urdf = read_input_file(file), .file = file});
  }
  return texts;
}

Instance::Facts facts_of(const Assembly& assembly, std::string mode, std::filesystem::path records) {
  const RobotConfig& robot = assembly.robot();
  return {.name = robot.name,
          .mode = std::move(mode),
          .version = version,
          .configuration = std::filesystem::absolute(robot.file).lexically_normal(),
          .root = project_root(assembly.scenario().file),
          .folders = folders_of(assembly.scenario()),
          .records = std::move(records),
          .control_period_s = robot.engine.control_period_s,
          .behavior_period_s = robot.engine.behavior_period_s,
          .subjects = viewer_subjects(assembly)};
}

LiveService::LiveService(const LiveServiceOptions& place, Instance& instance, const Assembly& assembly,
                         LivePace* pace) {
  if (!place.wanted()) return;
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

Ros2Service::Ros2Service(const Ros2Options& place, Instance& instance, const Assembly& assembly, LivePace* pace,
                         int avoid_cpu) {
  if (!place.wanted()) return;
  domain_ = domain_of(place);
  const RobotTexts texts = robot_texts(assembly);
  bridge_ = std::make_unique<Ros2Bridge>(
      Ros2Settings{.domain = domain_, .rate_hz = place.rate_hz, .commands = place.commands, .avoid_cpu = avoid_cpu},
      Ros2Bridge::Parts{.instance = instance, .port = instance.open_port(), .texts = texts, .pace = pace});
}

void Ros2Service::start() {
  if (!bridge_) return;
  bridge_->start();
  print_line("ros2 in domain " + std::to_string(domain_));
}

void Ros2Service::stop() noexcept {
  if (bridge_) bridge_->stop();
}

}  // namespace kadans
