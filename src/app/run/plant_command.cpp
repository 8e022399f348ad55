// `kadans plant`: serves a model of a robot in real time to control engines on other machines, one after the other.
// Each session begins with the robot in its configured start.
#include <algorithm>
#include <cstdio>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/assembly.h"
#include "app/author/file_checks.h"
#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "app/timing/run_report.h"
#include "config/json/foreign_json.h"
#include "kadans/plant/emulated_drives.h"
#include "kadans/plant/plant_type.h"
#include "plant/imu/emulator/imu_server.h"
#include "real_time_start.h"
#include "realtime/machine/keep_awake.h"
#include "realtime/machine/machine.h"
#include "realtime/posix_wait.h"
#include "realtime/task_thread.h"
#include "run_threads.h"

namespace kadans {
namespace {

constexpr int look_every_ms = 50;  // interval of checks for signals and the end of a session
constexpr std::uint32_t catch_up_max = 10;

// Steps the model each period. When it is late by more than a few periods, the rest is lost for the model and counted.
class ServeTask final : public Task {
 public:
  ServeTask(PlantEmulator& emulator, World& world) noexcept : emulator_(emulator), world_(world) {}
  bool beat(const Beat& beat) override {
    const std::uint32_t periods = std::min(1 + beat.missed, catch_up_max);
    lost_periods_ += 1 + std::uint64_t{beat.missed} - periods;
    return emulator_.beat(world_, periods);
  }
  std::uint64_t lost_periods() const noexcept { return lost_periods_; }  // call it after the thread has ended

 private:
  PlantEmulator& emulator_;
  World& world_;
  std::uint64_t lost_periods_ = 0;
};

class PlantService {
 public:
  explicit PlantService(const PlantOptions& options) : options_(options), robot_(read_robot(options.robot)) {
    if (!options.in_step || emulator_->step_with_peer()) return;
    throw InputError({.file = "--in-step",
                      .message = options.imu.empty()
                                     ? "the protocol '" + options.as + "' does not count the peer's ticks"
                                     : "does not go with --imu: its device measures by the clock"});
  }

  int run() {
    lock_program();
    bool failed = false, told = false;
    while (!interrupted()) {
      const std::unique_ptr<World> world = make();
      if (!std::exchange(told, true)) print_line("serves '" + robot_.config.name + "' on " + options_.listen);
      while (!interrupted() && !emulator_->await(look_every_ms)) {
      }
      if (interrupted()) break;
      failed = !serve(*world) || failed;
      if (options_.once) break;
    }
    return failed ? exit_failed : exit_passed;
  }

 private:
  std::unique_ptr<World> make() const {
    const RobotConfig& config = robot_.config;
    try {
      return served_.make_world({config.model, config.plant, options_.seed});
    } catch (const std::invalid_argument& error) {
      throw InputError({.file = config.file, .message = error.what()});
    }
  }

  std::unique_ptr<PlantEmulator> make_emulator() const {
    const PlantType& type = plant_type_named(robot_.config, "--as", {options_.as, {}}, &PlantType::is_protocol);
    PlantSite site = plant_site(robot_.config, "");
    site.seed = options_.seed;
    std::unique_ptr<PlantEmulator> drives = type.make_emulator(site, options_.listen);
    if (options_.imu.empty()) {
      plan_faults(*drives);
      return drives;
    }
    const imu::SerialImuSettings settings = serial_imu_at(robot_.config, type, "--imu", options_.imu);
    if (!settings.given())
      throw InputError({.file = "--imu", .message = "the protocol '" + options_.as + "' has the IMU in its frames"});
    auto both = std::make_unique<imu::ImuServer>(std::move(drives), settings, robot_.config.plant.imu.pose.orientation,
                                                 options_.imu);
    plan_faults(*both);
    return both;
  }

  void plan_faults(PlantEmulator& drives) const {
    for (const std::string& text : options_.faults) {
      try {
        drives.plan_faults({emulated_fault(text)});
      } catch (const std::invalid_argument& error) {
        throw InputError({.file = "--fault", .message = text + ": " + error.what()});
      }
    }
  }

  // Serves one session on a thread of its own. False when the model failed.
  bool serve(World& world) {
    print_line("driven by " + emulator_->peer_name());
    const std::int64_t period_ns = robot_.config.engine.control_period_ns();
    const bool one_cpu = sysconf(_SC_NPROCESSORS_ONLN) < 2;
    PosixWait wait(one_cpu ? 0 : default_spin_ns, WallClock().now_ns());
    ServeTask task(*emulator_, world);
    const int priority = read_rights("/").priority(plant_priority) ? plant_priority : 0;
    TaskThread thread({.name = "plant",
                       .period_ns = period_ns,
                       .first_ns = period_ns,
                       .priority = priority,
                       .cpu = options_.cpu >= 0 ? options_.cpu : real_time_cpu("/"),
                       .stack_bytes = std::size_t{1} << 20U},
                      task, wait);
    thread.start();
    while (!thread.over() && !interrupted()) usleep(1000 * look_every_ms);
    thread.stop();
    thread.join();
    tell(thread, task);
    return thread.failure()[0] == 0;
  }

  void tell(const TaskThread& thread, const ServeTask& task) const {
    const PlantEmulator::Session& s = emulator_->session();
    const TaskStatistics& timing = thread.statistics();
    const char* ended = thread.failure()[0] != 0 ? thread.failure() : s.left ? "the peer left" : "the peer fell silent";
    if (interrupted()) ended = "told to stop";
    if (options_.json) {
      const nlohmann::ordered_json json{{"ended", ended},
                                        {"beats", timing.lateness.count()},
                                        {"missed", timing.missed.get()},
                                        {"lost_periods", task.lost_periods()},
                                        {"lateness_us_p99", 1e-3 * timing.lateness.percentile_ns(0.99)},
                                        {"execution_us_p50", 1e-3 * timing.execution.percentile_ns(0.5)},
                                        {"execution_us_p99", 1e-3 * timing.execution.percentile_ns(0.99)},
                                        {"releases", s.releases},
                                        {"answer_ms_mean", 1e-6 * s.answer_mean_ns()},
                                        {"answer_ms_max", 1e-6 * static_cast<double>(s.answer_max_ns)},
                                        {"link", link_json(emulator_->link_counts())}};
      std::puts(json_text(json).c_str());
    } else {
      std::printf("%s after %llu beats, %llu missed; late p99 %.1f us, work p50 %.1f p99 %.1f us\n", ended,
                  static_cast<unsigned long long>(timing.lateness.count()),
                  static_cast<unsigned long long>(timing.missed.get()), 1e-3 * timing.lateness.percentile_ns(0.99),
                  1e-3 * timing.execution.percentile_ns(0.5), 1e-3 * timing.execution.percentile_ns(0.99));
      std::printf("  link: %s\n", link_text(emulator_->link_counts()).c_str());
      std::printf("  actuations answer samples %.2f ms old, %.2f at most; the watchdog released the joints %u times\n",
                  1e-6 * s.answer_mean_ns(), 1e-6 * static_cast<double>(s.answer_max_ns), s.releases);
    }
    std::fflush(stdout);
  }

  const PlantOptions& options_;
  Robot robot_;
  const PlantType& served_ = plant_type_named(robot_.config, "--plant", {options_.plant, {}}, &PlantType::is_model);
  std::unique_ptr<PlantEmulator> emulator_ = make_emulator();
};

}  // namespace

void add_plant(CLI::App& app, PlantOptions& options) {
  CLI::App* plant = app.add_subcommand(
      "plant",
      "Serve a model of a robot to programs that speak a protocol of drives, such as `kadans run --plant udp`");
  plant->add_option("robot", options.robot, "The robot's configuration (JSON)")->required()->type_name("FILE");
  plant
      ->add_option(
          "--listen", options.listen,
          "Address to listen on; \":7100\": port 7100 on every address of this machine; for servos the path of a "
          "serial port, which is made")
      ->required()
      ->type_name("HOST:PORT|PATH");
  plant
      ->add_option("--imu", options.imu,
                   "Serve the robot's plant.serial_imu, too: the path of a serial port, which is made")
      ->type_name("PATH");
  const auto names = [](bool (PlantType::*is)() const noexcept) {
    return CLI::detail::join(plant_type_names(is), ", ");
  };
  plant
      ->add_option("--plant", options.plant,
                   "What is served (default: bullet): " + names(&PlantType::is_model) + ", or a plug-in's model")
      ->type_name("TYPE");
  plant
      ->add_option("--as", options.as,
                   "In whose protocol (default: udp): " + names(&PlantType::is_protocol) + ", or a plug-in's type")
      ->type_name("TYPE");
  plant->add_option("--seed", options.seed, "Seed of the model's random numbers (default: 1)")
      ->type_name("N")
      ->check(any_seed());
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
  plant->add_option("--cpu", options.cpu, "CPU of the model's thread (default: an isolated one, else the last)")
      ->type_name("N")
      ->check(whole_within(0, 1023));
  plant->add_flag("--json", options.json, "Print each session as one JSON object on a line of its own");
}

int run_plant(const PlantOptions& options) {
  require_kind(options.robot, JsonKind::robot);
  if (!rights_suffice(plant_priority, options.soft)) return exit_usage;
  PlantService service(options);
  catch_interrupts();
  return service.run();
}

}  // namespace kadans
