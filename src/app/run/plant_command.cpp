// `kadans plant`: serves a model of a robot, or the robots of a scenario, in real time to control engines in other
// processes or on other machines, a peer for each robot. When all peers have gone, the world begins anew.
#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/assembly/assembled_plant.h"
#include "app/assembly/robot.h"
#include "app/author/file_checks.h"
#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "app/timing/run_report.h"
#include "config/json/foreign_json.h"
#include "kadans/plant/emulated_drives.h"
#include "kadans/plant/plant_type.h"
#include "plant/imu/emulator/imu_server.h"
#include "plant/world_server.h"
#include "real_time_start.h"
#include "realtime/machine/keep_awake.h"
#include "realtime/machine/machine.h"
#include "realtime/posix_wait.h"
#include "realtime/task_thread.h"
#include "run_threads.h"
#include "served_world.h"

namespace kadans {
namespace {

struct PlantOptions {
  std::string robot;                // or a scenario
  std::vector<std::string> listen;  // for each robot
  std::string imu;                  // link to the IMU's terminal; "": none is served
  std::string plant, as = "udp";    // plant types: of the served model ("": as the file says), of the protocol
  std::optional<std::uint64_t> seed;
  bool soft = false;                // also without the rights for real time
  bool once = false;                // ends with the first session
  std::vector<std::string> faults;  // "KIND:OF@FROM+FOR=SIZE"
  bool in_step = false;             // time passes with the peer's ticks
  int cpu = -1;                     // -1: the CPU that `kadans run` takes
  bool json = false;
};

constexpr int look_every_ms = 50;  // interval of checks for signals and the end of a session
constexpr std::uint32_t catch_up_max = 10;

// Lets the world's time pass each period. When it is late by more than a few periods, the rest is lost and counted.
class ServeTask final : public Task {
 public:
  ServeTask(WorldServer& server, World& world, std::int64_t period_ns) noexcept
      : server_(server), world_(world), period_ns_(period_ns) {}
  bool beat(const Beat& beat) override {
    const std::uint32_t periods = std::min(1 + beat.missed, catch_up_max);
    lost_periods_ += 1 + std::uint64_t{beat.missed} - periods;
    return server_.beat(world_, periods, period_ns_);
  }
  std::uint64_t lost_periods() const noexcept { return lost_periods_; }  // call it after the thread has ended

 private:
  WorldServer& server_;
  World& world_;
  std::int64_t period_ns_;
  std::uint64_t lost_periods_ = 0;
};

class PlantService {
 public:
  explicit PlantService(const PlantOptions& options) : options_(options) {
    if (kind_in(options.robot) == JsonKind::scenario) {
      scenario_ = read_scenario_config(options.robot);
      if (!options.plant.empty()) refuse("--plant", "does not go with a scenario, which says its plant");
    } else {
      require_kind(options.robot, JsonKind::robot);
      robot_ = read_robot(options.robot);
    }
    server_ = make_server();
    if (!options.in_step) return;
    if (names_.size() > 1) refuse("--in-step", "is for one robot; the peers of several have the clock's time");
    if (!server_->emulator(0).step_with_peer())
      refuse("--in-step", options.imu.empty() ? "the protocol '" + options.as + "' does not count the peer's ticks"
                                              : "does not go with --imu: its device measures by the clock");
  }

  int run() {
    lock_program();
    bool failed = false;
    for (std::size_t i = 0; i < names_.size(); ++i) print_line("serves '" + names_[i] + "' on " + options_.listen[i]);
    while (!interrupted()) {
      if (world_ == nullptr) world_ = make();
      server_->look(*world_);
      while (!interrupted() && !server_->await(look_every_ms)) {
      }
      if (interrupted()) break;
      failed = !serve(*world_) || failed;
      world_.reset();
      if (options_.once) break;
    }
    return failed ? exit_failed : exit_passed;
  }

 private:
  std::unique_ptr<ServedWorld> make() const {
    if (!scenario_)
      return std::make_unique<ServedWorld>(*robot_, options_.plant.empty() ? "bullet" : options_.plant,
                                           options_.seed.value_or(1));
    return std::make_unique<ServedWorld>(*scenario_, options_.seed.value_or(scenario_->seed));
  }

  // What is listened on is known to be free before the first peer comes.
  std::unique_ptr<WorldServer> make_server() {
    world_ = make();
    const std::vector<ServedWorld::Site>& sites = world_->sites();
    for (const ServedWorld::Site& site : sites) names_.push_back(site.name.empty() ? site.robot.name : site.name);
    if (options_.listen.size() != sites.size())
      refuse("--listen", sites.size() == 1 ? "one robot is served: give one address"
                                           : "once for each robot, in this order: " + CLI::detail::join(names_, ", "));
    if (sites.size() > 1 && !(options_.imu.empty() && options_.faults.empty()))
      refuse(options_.imu.empty() ? "--fault" : "--imu", "is for one robot alone");
    std::vector<std::unique_ptr<PlantEmulator>> emulators;
    for (std::size_t i = 0; i < sites.size(); ++i)
      emulators.push_back(make_emulator(sites[i].robot, options_.listen[i]));
    period_ns_ = sites.front().robot.engine.control_period_ns();
    return std::make_unique<WorldServer>(std::move(emulators));
  }

  std::unique_ptr<PlantEmulator> make_emulator(const RobotConfig& robot, const std::string& listen) const {
    const PlantType& type = plant_type_named(robot, "--as", {options_.as, {}}, &PlantType::is_protocol);
    PlantSite site = plant_site(robot, "");
    site.seed = options_.seed.value_or(1);
    std::unique_ptr<PlantEmulator> made = type.make_emulator(site, listen);
    if (!options_.imu.empty()) {
      const imu::SerialImuSettings settings = serial_imu_at(robot, type, "--imu", options_.imu);
      if (!settings.given()) refuse("--imu", "the protocol '" + options_.as + "' has the IMU in its frames");
      made =
          std::make_unique<imu::ImuServer>(std::move(made), settings, robot.plant.imu.pose.orientation, options_.imu);
    }
    for (const std::string& text : options_.faults) {
      try {
        made->plan_faults({emulated_fault(text)});
      } catch (const std::invalid_argument& error) {
        refuse("--fault", text + ": " + error.what());
      }
    }
    return made;
  }

  // Serves until all peers have gone, on a thread of its own. False when the model failed.
  bool serve(World& world) {
    for (std::size_t i = 0; i < names_.size(); ++i) print_line(of(i) + "driven by " + server_->emulator(i).peer_name());
    const bool one_cpu = sysconf(_SC_NPROCESSORS_ONLN) < 2;
    PosixWait wait(one_cpu ? 0 : default_spin_ns, WallClock().now_ns());
    ServeTask task(*server_, world, period_ns_);
    const int priority = read_rights("/").priority(plant_priority) ? plant_priority : 0;
    TaskThread thread({.name = "plant",
                       .period_ns = period_ns_,
                       .first_ns = period_ns_,
                       .priority = priority,
                       .cpu = options_.cpu >= 0 ? options_.cpu : real_time_cpu("/"),
                       .stack_bytes = std::size_t{1} << 20U},
                      task, wait);
    thread.start();
    while (!thread.over() && !interrupted()) {
      usleep(1000 * look_every_ms);
      if (names_.size() > 1 && !options_.json) tell_ended(server_->take_ended(), "");
    }
    thread.stop();
    thread.join();
    server_->abandon();
    tell(thread, task);
    return thread.failure()[0] == 0;
  }

  std::string of(std::size_t robot) const { return names_.size() == 1 ? "" : names_[robot] + ": "; }

  // `why`: all sessions end by it.
  static std::string end_of(const WorldServer::Ended& session, const std::string& why) {
    return session.abandoned ? why : session.session.left ? "the peer left" : "the peer fell silent";
  }

  void tell_ended(const std::vector<WorldServer::Ended>& sessions, const std::string& why) {
    for (const WorldServer::Ended& ended : sessions) {
      const PlantEmulator::Session& s = ended.session;
      if (names_.size() > 1) std::printf("%s%s\n", of(ended.robot).c_str(), end_of(ended, why).c_str());
      std::printf("  link: %s\n", link_text(ended.link_counts).c_str());
      std::printf("  actuations answer samples %.2f ms old, %.2f at most; the watchdog released the joints %u times\n",
                  1e-6 * s.answer_mean_ns(), 1e-6 * static_cast<double>(s.answer_max_ns), s.releases);
    }
    std::fflush(stdout);
  }

  void tell(const TaskThread& thread, const ServeTask& task) {
    const TaskStatistics& timing = thread.statistics();
    const std::string why = interrupted() ? "told to stop" : thread.failure();
    const std::vector<WorldServer::Ended> sessions = server_->take_ended();
    if (options_.json) {
      for (const WorldServer::Ended& ended : sessions) {
        const PlantEmulator::Session& s = ended.session;
        nlohmann::ordered_json json{{"ended", end_of(ended, why)},
                                    {"beats", timing.lateness.count()},
                                    {"missed", timing.missed.get()},
                                    {"lost_periods", task.lost_periods()},
                                    {"lateness_us_p99", 1e-3 * timing.lateness.percentile_ns(0.99)},
                                    {"execution_us_p50", 1e-3 * timing.execution.percentile_ns(0.5)},
                                    {"execution_us_p99", 1e-3 * timing.execution.percentile_ns(0.99)},
                                    {"releases", s.releases},
                                    {"answer_ms_mean", 1e-6 * s.answer_mean_ns()},
                                    {"answer_ms_max", 1e-6 * static_cast<double>(s.answer_max_ns)},
                                    {"link", link_json(ended.link_counts)}};
        if (names_.size() > 1) json["robot"] = names_[ended.robot];
        std::puts(json_text(json).c_str());
      }
      std::fflush(stdout);
      return;
    }
    const bool alone = names_.size() == 1 && !sessions.empty();
    std::printf("%s after %llu beats, %llu missed; late p99 %.1f us, work p50 %.1f p99 %.1f us\n",
                alone         ? end_of(sessions.front(), why).c_str()
                : why.empty() ? "no peer is left"
                              : why.c_str(),
                static_cast<unsigned long long>(timing.lateness.count()),
                static_cast<unsigned long long>(timing.missed.get()), 1e-3 * timing.lateness.percentile_ns(0.99),
                1e-3 * timing.execution.percentile_ns(0.5), 1e-3 * timing.execution.percentile_ns(0.99));
    tell_ended(sessions, why);
  }

  const PlantOptions& options_;
  std::optional<ScenarioConfig> scenario_;
  std::optional<Robot> robot_;
  std::unique_ptr<ServedWorld> world_;  // made before it is needed
  std::vector<std::string> names_;      // of the robots
  std::int64_t period_ns_ = 0;
  std::unique_ptr<WorldServer> server_;
};

int run_plant(const PlantOptions& options) {
  if (!rights_suffice(plant_priority, options.soft)) return exit_usage;
  PlantService service(options);
  catch_interrupts();
  return service.run();
}

}  // namespace

void add_plant(CommandLine& line) {
  const auto [plant, options] = line.add<PlantOptions>(
      "plant",
      "Serve a model of a robot, or the robots of a scenario, to programs that speak a protocol of drives, such as "
      "`kadans run --plant udp`",
      run_plant);
  plant->add_option("robot", options.robot, "The robot's configuration, or a scenario with one or several (JSON)")
      ->required()
      ->type_name("FILE");
  plant
      ->add_option(
          "--listen", options.listen,
          "Address to listen on; \":7100\": port 7100 on every address of this machine; for servos the path of a "
          "serial port, which is made; once for each robot of a scenario")
      ->required()
      ->type_name("HOST:PORT|PATH")
      ->allow_extra_args(false);
  plant
      ->add_option("--imu", options.imu,
                   "Serve the robot's plant.serial_imu, too: the path of a serial port, which is made")
      ->type_name("PATH");
  const auto names = [](bool (PlantType::*is)() const noexcept) {
    return CLI::detail::join(plant_type_names(is), ", ");
  };
  plant
      ->add_option(
          "--plant", options.plant,
          "What is served of a robot (default: bullet): " + names(&PlantType::is_model) + ", or a plug-in's model")
      ->type_name("TYPE");
  plant
      ->add_option("--as", options.as,
                   "In whose protocol (default: udp): " + names(&PlantType::is_protocol) + ", or a plug-in's type")
      ->type_name("TYPE");
  add_seed(*plant, options.seed, "Seed of the model's random numbers (default: 1, or the scenario's)");
  plant
      ->add_option(
          "--fault", options.faults,
          "What befalls the bus or its drives, S seconds after the first torque, for D seconds: cable_out@2+0.5, "
          "bytes_lost@1+4=0.02, drive_hot:tilt@3=85")
      ->type_name("KIND[:OF]@S[+D][=SIZE]")
      ->allow_extra_args(false);
  plant->add_flag("--once", options.once, "End with the first session");
  plant->add_flag("--in-step", options.in_step,
                  "Let time pass with the peer's ticks, not with the clock: for a peer that is emulated or debugged");
  plant->add_flag("--soft", options.soft, "Run even without the rights that real time needs");
  add_whole(*plant, "--cpu", options.cpu, 0, 1023,
            "CPU of the model's thread (default: an isolated one, else the last)");
  plant->add_flag("--json", options.json, "Print each session as one JSON object on a line of its own");
}

}  // namespace kadans
