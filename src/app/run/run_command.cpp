// `kadans run`: runs the engines on real threads, and the supervisor that starts, watches and ends them.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iterator>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include <unistd.h>

#include "app/assembly/assembly.h"
#include "app/author/file_checks.h"
#include "app/commands.h"
#include "app/option_checks.h"
#include "app/sim/input_files.h"
#include "app/sim/played_behaviors.h"
#include "app/terminal.h"
#include "app/timing/run_report.h"
#include "behavior_process.h"
#include "config/robot/project_root.h"
#include "config/scenario/play_item.h"
#include "disk_thread.h"
#include "engine/behavior_engine.h"
#include "engine/behavior_log.h"
#include "engine/tick/control_engine.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/nearest_name.h"
#include "last_resort.h"
#include "plant/joystick/joystick_device.h"
#include "real_time_start.h"
#include "realtime/engine_tasks.h"
#include "realtime/machine/machine.h"
#include "realtime/machine/placement.h"
#include "realtime/machine/service_notifier.h"
#include "realtime/task_thread.h"
#include "remote/instance/behavior_side.h"
#include "remote/instance/control_side.h"
#include "remote/instance/record_side.h"
#include "run_threads.h"
#include "script/host/safe_posture.h"
#include "version.h"

namespace kadans {
namespace {

// The joystick of a live run. A task reads it a hundred times a second, so the engines never wait for it. It also
// reports when the joystick is unplugged.
class JoystickTask final : public Task {
 public:
  // `path` is a device or a recording; "": the one in the settings. Throws InputError when it cannot be read.
  JoystickTask(const JoystickSettings& settings, const std::string& path, JoystickStorage& storage)
      : storage_(storage), source_(make_joystick(settings, path.empty() ? settings.device : path)) {}

  bool beat(const Beat& beat) override {
    storage_.publish(source_->at(beat.due_ns));
    return true;
  }

  // Supervisor: says that the joystick was plugged in or unplugged since the last call.
  void tell_news(const Snapshot& snapshot, BehaviorLog& log) {
    if (snapshot.tick == 0 || snapshot.joystick.connected == connected_) return;
    connected_ = snapshot.joystick.connected;
    log.message(snapshot.time_ns, connected_ ? BehaviorLog::Severity::info : BehaviorLog::Severity::error, "joystick",
                connected_ ? "is there" : "is gone; it reads as centred until it is plugged in again");
  }

 private:
  JoystickStorage& storage_;
  std::unique_ptr<JoystickSource> source_;
  bool connected_ = false;
};

class SupervisorTask final : public Task {
 public:
  explicit SupervisorTask(Supervisor& supervisor) noexcept : supervisor_(supervisor) {}
  bool beat(const Beat& beat) override {
    supervisor_.tick(beat.due_ns);
    return true;
  }

 private:
  Supervisor& supervisor_;
};

// Prepares a robot for being switched off: the playing behaviors leave their states, then the robot moves to the safe
// posture of its configuration. It runs on the behavior thread after the supervisor has called ask().
class Leaving final : public BesideTick {
 public:
  // Throws InputError on an unknown pose.
  Leaving(const SafePosture::Settings& posture, const Catalog& catalog, OrderTaker& host, BehaviorEngine& behaviors,
          EngineExchange& exchange)
      : posture_({.pose = posture.pose, .after_s = 0, .time_s = posture.time_s}, catalog),
        host_(host),
        behaviors_(behaviors),
        exchange_(exchange) {}

  void ask() noexcept { asked_.store(true, std::memory_order_relaxed); }  // supervisor
  void beside_tick(std::int64_t time_ns) override {
    if (!asked_.load(std::memory_order_relaxed)) return;
    if (step_ == Step::play) {
      try {
        host_.order({.kind = PlayOrder::Kind::stop});  // carried out in the tick that follows
      } catch (const InputError&) {                    // the process of the behaviors is down
      }
      step_ = Step::leave;
      return;
    }
    if (step_ == Step::leave) posture_.failed(time_ns, ~ObjectMask{0});
    step_ = Step::move;
    if (posture_.due(time_ns)) {
      const auto snapshot = exchange_.snapshot.read(0);
      posture_.move(*snapshot, behaviors_.sender(), 0);
    }
  }

 private:
  enum class Step : std::uint8_t { play, leave, move };

  SafePosture posture_;
  OrderTaker& host_;
  BehaviorEngine& behaviors_;
  EngineExchange& exchange_;
  std::atomic<bool> asked_{false};
  Step step_ = Step::play;
};

constexpr std::int64_t supervisor_period_ns = 50'000'000;
constexpr std::size_t log_lines_max = 1000;
constexpr double state_period_s = 2;  // between saved states of the control engine
// Limits at the end of a run: for threads that were told to stop or stand still, for each other part, for a server, for
// a record on a slow disk; and for virtual time that stands still.
constexpr std::int64_t joining_ns = 500'000'000, stage_ns = 1'000'000'000, service_ns = 5'000'000'000,
                       record_ns = 10'000'000'000, standing_ns = 2'000'000'000;
// With --soft others may keep the processor for seconds: a thread that ends late does not hang. A control thread that
// stands still no longer reaches the drives, whatever the reason.
constexpr std::int64_t soft_patience = 10;

// "FOLDER/", or a folder that is there: numbered records in it.
bool names_a_folder(const std::string& record) {
  std::error_code none;
  return record.ends_with('/') || (!record.empty() && std::filesystem::is_directory(record, none));
}

// Throws InputError when it has to be made and cannot be.
std::filesystem::path folder_of_records(const std::string& record) {
  namespace fs = std::filesystem;
  if (!names_a_folder(record)) return (fs::current_path() / record).parent_path();
  std::error_code error;
  fs::create_directories(record, error);
  if (error) refuse(record, "cannot be made: " + error.message());
  return fs::canonical(record);
}

// Many runs on virtual time may go on at the same time. So a run on virtual time is reachable only when a folder was
// named.
CtlServiceOptions place_of(const RunOptions& options) {
  CtlServiceOptions place = options.ctl;
  place.wanted = place.wanted && (!options.virtual_time || !place.folder.empty());
  return place;
}

RunTiming timing_of(const RunOptions& options, const EngineSettings& engine) {
  const std::int64_t period_ns = engine.control_period_ns();
  const bool one_cpu = sysconf(_SC_NPROCESSORS_ONLN) < 2;
  const double spin_us = options.spin_us > 0 ? options.spin_us : 1e-3 * static_cast<double>(default_spin_ns);
  return {.control_period_ns = period_ns,
          .behavior_period_ns = engine.behavior_divisor() * period_ns,
          .virtual_time = options.virtual_time,
          .real_time = read_rights("/").priority(plant_priority),
          .keep_awake = options.keep_awake && !one_cpu,
          .spin_ns = options.sleep_only || one_cpu ? 0 : std::llround(1e3 * spin_us),
          .cpu = options.cpu >= 0 ? options.cpu : real_time_cpu("/")};
}

// The time in ms from the start of this process to a time on CLOCK_MONOTONIC, with a resolution of 10 ms.
double ms_since_start(std::int64_t monotonic_ns) {
  std::ifstream file("/proc/self/stat");
  std::string text{std::istreambuf_iterator<char>(file), {}};
  std::istringstream fields(text.substr(text.rfind(')') + 1));
  std::string skipped;
  for (int i = 3; i < 22; ++i) fields >> skipped;
  double began_ticks = 0;
  fields >> began_ticks;
  timespec boot{};
  clock_gettime(CLOCK_BOOTTIME, &boot);
  const double boot_s = static_cast<double>(boot.tv_sec) + 1e-9 * static_cast<double>(boot.tv_nsec);
  const double ahead_s = 1e-9 * static_cast<double>(monotonic_ns - WallClock().now_ns());
  return 1e3 * (boot_s + ahead_s - began_ticks / static_cast<double>(sysconf(_SC_CLK_TCK)));
}

std::string environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): before any thread is started
  return value == nullptr ? "" : value;
}

class WallClockRun {
 public:
  explicit WallClockRun(const RunOptions& options)
      : options_(options),
        scenario_(live_scenario(options)),
        link_(std::make_unique<PlantExchange>()),
        process_(options.behaviors == "process" ? start_behavior_process(options, log_) : nullptr),
        assembly_(scenario_, scenario_.seed, log_, link_.get(), outside()),
        parts_{assembly_.control(), assembly_.behaviors()},
        truth_(assembly_.truth() == nullptr ? nullptr
                                            : std::make_unique<TruthTask>(*assembly_.truth(), parts_.control)),
        plant_(assembly_.world() == nullptr
                   ? nullptr
                   : std::make_unique<PlantTask>(*link_, *assembly_.world(),
                                                 assembly_.robot().engine.control_period_ns())),
        joystick_(make_joystick()),
        supervisor_(assembly_.supervisor() == nullptr ? nullptr
                                                      : std::make_unique<SupervisorTask>(*assembly_.supervisor())),
        leaving_({.pose = assembly_.robot().safe.pose, .time_s = assembly_.robot().safe.time_s}, assembly_.catalog(),
                 assembly_.orders(), parts_.behaviors, parts_.control.exchange()) {
    log_.add(record_side_);
    const Shown unasked = stderr_is_journal() ? Shown::messages : Shown::errors;  // readers of a journal choose
    said_.add(stderr_sink(options.verbose ? Shown::all : unasked));
    if (options.log_file.empty()) return;
    log_file_.emplace(options.log_file);
    said_.add(log_file_->sink());
    program_log().add(log_file_->sink());
  }

  int run() {
    if (options_.virtual_time && assembly_.world() == nullptr) {
      refuse("--threads-on-virtual-time", "a plant that is no model has its own time");
    }
    refuse_faulty_behaviors(scenario_, assembly_.catalog());
    assembly_.record_to(&control_side_);
    record_side_.describe_with(robot_texts(assembly_));
    RecordPlan plan = record_plan(assembly_, options_.recording, !options_.virtual_time);
    const bool flies = plan.flight.kept_s > 0;
    if (assembly_.robot().record.inputs && (flies || !options_.record.empty())) record_inputs(plan);
    plan.timing = {{"Control tick: takes", &control_.tick_cost()}};
    plan.fault_state = &assembly_.control().fault_state();
    record_side_.record_as(std::move(plan));
    record_side_.begin();
    if (!options_.record.empty()) record_side_.start(names_a_folder(options_.record) ? "" : options_.record);
    const bool may_record = flies || !options_.record.empty() || place_of(options_).wanted || options_.live.wanted() ||
                            options_.ros2.commands;
    const RunTiming timing = timing_of(options_, assembly_.robot().engine);
    if (!timing.virtual_time) lock_program();
    ctl_.start();  // clients that connect before the first tick may read, and stop the robot
    if (!assembly_.plant().open(interrupted)) return exit_interrupted;
    LastResort last_resort(timing.real_time && !timing.virtual_time ? last_resort_priority : 0, exit_failed);
    RunThreads threads(timing,
                       {control_, behaviors_, plant_.get(), may_record ? &record_side_ : nullptr, joystick_.get(),
                        supervisor_.get(), supervisor_ ? assembly_.supervisor()->period_ns() : 0});
    if (!threads.start()) return end_before_start(threads, last_resort);
    if (may_record && !timing.virtual_time) disk_.start();
    const double start_ms = ms_since_start(threads.origin_ns() + timing.control_period_ns);
    live_.start({{"Control tick: late", &threads.control().statistics().lateness},
                 {"Control tick: takes", &control_.tick_cost()},
                 {"Behavior tick: takes", &threads.behaviors().statistics().execution}});
    ros2_.start();
    notifier_.ready("drives " + assembly_.robot().name);
    if (timing.real_time && !timing.virtual_time) (void)take_priority(supervisor_priority);
    const std::string ended = watch(threads);
    notifier_.stopping();
    leave(threads);
    const std::vector<std::string> hanging = switch_off(threads, last_resort);
    end_services(last_resort);
    WallClockResult result{threads,
                           control_,
                           parts_.behaviors,
                           parts_.control,
                           plant_.get(),
                           assembly_.plant().link_counts(),
                           record_side_.recorder(),
                           process_.get(),
                           assembly_.decision_process(),
                           left_at_s_,
                           start_ms,
                           ended,
                           failed_};
    result.failed = result.failed || log_.has_errors() || !hanging.empty() || (log_file_ && log_file_->failed());
    std::fputs((options_.json ? run_report_json(result) + "\n" : run_report_text(result)).c_str(), stdout);
    if (!hanging.empty()) leave_behind(hanging);
    return result.failed ? exit_failed : exit_passed;
  }

 private:
  // What a repetition of this run needs: of all of it in a record, of its last seconds in a flight record.
  void record_inputs(RecordPlan& plan) {
    const bool recorded = !options_.record.empty();
    RunInputs inputs = inputs_of(options_, scenario_, assembly_);
    if (recorded)
      take_inputs(inputs);
    else
      taken_.emplace(RecordedInputs::FlightAlone());
    const HandOvers hand_overs = assembly_.sets().hand_overs();
    const std::vector<const DownStorage*> down(hand_overs.down.begin(), hand_overs.down.end());
    InputLayout layout = layout_of(assembly_);
    plan.inputs = {.pieces = std::make_unique<InputPieces>(parts_.control, layout, down),
                   .behaviors = &*taken_,
                   .in_files = recorded};
    if (taken_to_decide_) {
      plan.inputs.decisions = &*taken_to_decide_;
      assembly_.supervisor()->take_inputs_by(&*taken_to_decide_);
    }
    parts_.behaviors.take_inputs_by(&*taken_, recorded ? hand_overs.up : std::vector<UpStorage*>{});
    if (process_ == nullptr && recorded) assembly_.host().take_inputs_by(&*taken_);
    if (plan.flight.kept_s > 0) {
      const double period_s = assembly_.robot().engine.control_period_s;
      states_.emplace(parts_.control, down, static_cast<std::uint64_t>(std::ceil(state_period_s / period_s)));
      for (std::uint32_t i = 0; i < hand_overs.down.size(); ++i) hand_overs.down[i]->tell(&*taken_, i);
      layout.state_bytes = static_cast<std::uint32_t>(states_->bytes_max());
      plan.flight.inputs = layout;
      plan.flight.every_ticks = repeated_flight_ticks(assembly_.catalog().signals, period_s);
      plan.inputs.states = &*states_;
      inputs.pack();
      std::size_t beside = states_->bytes_max() + (recorded ? 0 : RecordedInputs::flight_bytes);
      for (const InputFile& file : inputs.files) beside += file.packed.size();
      plan.flight.bytes -= std::min(beside, plan.flight.bytes / 2);  // all that it keeps is within its memory
    }
    record_side_.describe_with(std::move(inputs));
  }

  void take_inputs(const RunInputs& inputs) {
    const std::string root = project_root(scenario_.file).string();
    taken_.emplace(root, names_of(assembly_.robot().record.private_files));
    if (assembly_.supervisor() != nullptr && assembly_.supervisor()->decider() != nullptr)
      taken_to_decide_.emplace(root, names_of(assembly_.robot().record.private_files));
    for (const InputFile& file : inputs.files) {
      const std::string& known = file.text ? *file.text : file.hash;
      taken_->knows(file.path, known);
      if (taken_to_decide_) taken_to_decide_->knows(file.path, known);
    }
  }

  Assembly::Outside outside() {
    Assembly::Outside outside{.behaviors = process_.get()};
    if ((options_.decisions.empty() ? options_.behaviors : options_.decisions) == "process") {
      outside.decisions = [this](BehaviorLog& log, std::int64_t period_ns) {
        return start_decision_process(options_, log, period_ns);
      };
    }
    return outside;
  }

  std::unique_ptr<JoystickTask> make_joystick() {
    const JoystickSettings& settings = assembly_.robot().joystick;
    if (options_.joystick.empty() && settings.device.empty()) return nullptr;
    return std::make_unique<JoystickTask>(settings, options_.joystick, parts_.control.exchange().joystick);
  }

  // Switches the drives off and closes the record, even when threads hang. Returns the names of hanging threads.
  std::vector<std::string> switch_off(RunThreads& threads, LastResort& last_resort) {
    const auto hangs = [](const std::vector<std::string>& hanging, const char* name) {
      return std::ranges::find(hanging, name) != hanging.end();
    };
    const std::int64_t patience_ns = (options_.soft ? soft_patience : 1) * joining_ns;
    last_resort.expect("switching the drives off", 3 * patience_ns + stage_ns);
    ActuationFrame off;
    off.joint_count = static_cast<std::uint32_t>(assembly_.robot().model.joints.size());
    // A control thread that stands still is not waited for.
    if (stands_still_) (void)assembly_.last_word()->say(off, 0);
    std::vector<std::string> hanging = threads.stop(patience_ns);
    if (assembly_.last_word()->say(off, patience_ns)) {
      assembly_.plant().close();
    } else {
      print_error("the plant hangs: its drives' own watchdog must switch them off");
    }
    tell(threads.supervisor().now_ns());
    last_resort.expect("closing the record", record_ns);
    if (hangs(hanging, "record")) {
      print_error("the record is not complete: its thread hangs");
    } else if (!record_side_.end()) {
      failed_ = true;
      print_error("the record is not complete: " + record_side_.error());
    }
    disk_.stop();
    tell_flights(record_side_.status());
    return hanging;
  }

  void end_services(LastResort& last_resort) {
    last_resort.expect("the service of ROS 2", service_ns);
    ros2_.stop();
    last_resort.expect("the live server", service_ns);
    live_.stop();
    last_resort.expect("the server of kadans ctl", service_ns);
    ctl_.stop();
    last_resort.expect("the end of the run", record_ns);
  }

  int end_before_start(RunThreads& threads, LastResort& last_resort) {
    print_error("told to stop before all threads had a CPU; nothing has begun");
    const std::vector<std::string> hanging = switch_off(threads, last_resort);
    end_services(last_resort);
    if (!hanging.empty()) leave_behind(hanging);
    return exit_interrupted;
  }

  // Ends by _exit, because a hanging thread still uses objects that a return would destroy.
  [[noreturn]] static void leave_behind(const std::vector<std::string>& hanging) {
    for (const std::string& name : hanging) print_error("the thread '" + name + "' hangs; the run ended without it");
    std::fflush(nullptr);
    _exit(exit_failed);
  }

  // Watches until the run ends. Returns the reason.
  std::string watch(RunThreads& threads) {
    Wait& wait = threads.supervisor();
    for (std::int64_t at_ns = supervisor_period_ns;; at_ns += supervisor_period_ns) {
      const bool last = options_.duration_s && static_cast<double>(at_ns) >= *options_.duration_s * 1e9;
      wait.until(last ? std::llround(*options_.duration_s * 1e9) : at_ns);
      if (at_ns < wait.now_ns() - supervisor_period_ns) at_ns = wait.now_ns();
      left_at_s_ = 1e-9 * static_cast<double>(wait.now_ns());
      notifier_.alive(control_.ticks());
      tell(wait.now_ns());
      for (const auto& thread : threads.all()) {
        if (!thread->over()) continue;
        failed_ = true;
        return thread->settings().name + " ended: " + thread->failure();
      }
      if (interrupted()) return "told to stop";
      if (last) return "duration over";
    }
  }

  // The robot moves to the safe posture, damps, and is off. The posture is left out when a thread failed or the robot
  // is already held.
  void leave(RunThreads& threads) {
    const SafetySettings& safety = parts_.control.safety().settings();
    const bool held = level() >= SafetyLevel::hold;
    failed_ = failed_ || held;
    record_side_.expect_end();
    assembly_.stop_deciding();
    if (!failed_) {
      leaving_.ask();
      pass(threads, assembly_.robot().safe.time_s + 0.2);
    }
    parts_.control.safety().emergency_stop().leave();
    pass(threads, safety.damp_s + 0.05);
  }

  SafetyLevel level() {
    const auto snapshot = parts_.control.exchange().snapshot.read(1);
    return snapshot->status.safety.level;
  }

  // Lets `seconds` pass. It does not wait for a control thread that stands still: then a thread hangs.
  void pass(RunThreads& threads, double seconds) {
    Wait& wait = threads.supervisor();
    const std::int64_t patience_ns = options_.virtual_time ? standing_ns : joining_ns;
    const std::int64_t end_ns = wait.now_ns() + std::llround(seconds * 1e9);
    std::int64_t moved_ns = WallClock().now_ns();
    for (std::uint64_t ticks = control_.ticks(); !stands_still_ && wait.now_ns() < end_ns;) {
      wait.until(std::min(end_ns, wait.now_ns() + supervisor_period_ns));
      if (std::exchange(ticks, control_.ticks()) != control_.ticks()) moved_ns = WallClock().now_ns();
      stands_still_ = WallClock().now_ns() >= moved_ns + patience_ns;
      notifier_.alive(control_.ticks());
      tell(wait.now_ns());
    }
  }

  // Reports the messages of behaviors, and faults except late ticks, which the final report counts.
  void tell(std::int64_t time_ns) {
    Event event;
    while (told_.pop(time_ns, event)) event.say_to(said_);
    if (joystick_ != nullptr) {
      const auto snapshot = parts_.control.exchange().snapshot.read(1);
      joystick_->tell_news(*snapshot, said_);
    }
    Fault fault;
    while (parts_.control.safety().log().try_pop(fault)) {
      instance_.tell(fault);
      record_side_.tell(fault);
      if (fault.code == FaultCode::tick_overrun) continue;
      program_log().message(time_ns, BehaviorLog::Severity::error, "",
                            "fault " + fault_text(told(fault, assembly_.robot().model)));
    }
    const RecordStatus record = record_side_.status();
    tell_flights(record);
    const auto snapshot = parts_.control.exchange().snapshot.read(1);
    instance_.publish(status_of(*snapshot, record));
  }

  void tell_flights(const RecordStatus& status) {
    if (status.flights == told_flights_) return;
    told_flights_ = status.flights;
    print_line(std::string("flight record: ") + status.flight.data());
  }

  const RunOptions& options_;
  ScenarioConfig scenario_;
  ServiceNotifier notifier_{environment("NOTIFY_SOCKET")};
  EventLog told_;  // from the behavior thread to the supervisor
  LineEcho echo_;
  RunLog log_{{&told_, &echo_}, log_lines_max};  // behavior thread
  std::unique_ptr<PlantExchange> link_;
  std::unique_ptr<ProcessHost> process_;  // of the behaviors, or nullptr
  Assembly assembly_;
  struct {
    ControlEngine& control;
    BehaviorEngine& behaviors;
  } parts_;
  std::optional<RecordedInputs> taken_, taken_to_decide_;
  std::optional<EngineStates> states_;
  std::unique_ptr<TruthTask> truth_;  // of a model, or nullptr
  std::unique_ptr<PlantTask> plant_;  // of a model, or nullptr
  std::unique_ptr<JoystickTask> joystick_;
  std::unique_ptr<SupervisorTask> supervisor_;  // of the decisions, or nullptr
  Leaving leaving_;
  Instance instance_{
      facts_of(assembly_, options_.virtual_time ? "run on virtual time" : "run", folder_of_records(options_.record)),
      assembly_.catalog(), parts_.control.safety().emergency_stop()};
  ControlSide control_side_{instance_};
  RecordSide record_side_{instance_,
                          control_side_,
                          {{"robot", scenario_.robot}, {"seed", std::to_string(scenario_.seed)}, {"kadans", version}}};
  BehaviorLog said_{&instance_};  // supervisor
  std::optional<LogFile> log_file_;
  BehaviorSide behavior_side_{{instance_, process_ ? nullptr : &assembly_.host(), process_.get(), parts_.behaviors,
                               parts_.control.exchange(), echo_, log_, assembly_.decision_questions()},
                              &leaving_};
  CtlService ctl_{place_of(options_), instance_};
  LiveService live_{options_.live, instance_, assembly_};
  Ros2Service ros2_{options_.ros2, instance_, assembly_, nullptr,
                    options_.virtual_time ? -1 : timing_of(options_, assembly_.robot().engine).cpu};
  DiskThread disk_{record_side_};
  ControlTask control_{parts_.control, truth_.get()};
  BehaviorTask behaviors_{parts_.behaviors, &behavior_side_};
  double left_at_s_ = 0;
  bool stands_still_ = false;  // the control thread, at the end
  std::uint32_t told_flights_ = 0;
  bool failed_ = false;
};

int run_live(const RunOptions& options) {
  require_kind(options.robot, JsonKind::robot);
  if (!options.virtual_time && !rights_suffice(plant_priority, options.soft)) return exit_usage;
  WallClockRun run(options);
  catch_interrupts();
  return run.run();
}

// " bullet, the robot's model ...; udp, a plant on another machine"
std::string plant_type_docs() {
  std::string docs;
  for (const auto& type : plant_types()) {
    docs += docs.empty() ? " " : "; ";
    docs += std::string(type->name()) + ", " + std::string(type->doc());
  }
  return docs;
}

}  // namespace

void add_run(CommandLine& line) {
  const auto [run, options] = line.add<RunOptions>(
      "run", "Drive a robot, or a model of it, on the wall clock until SIGINT or SIGTERM", run_live);
  run->add_option("robot", options.robot, "The robot's configuration (JSON)")->required()->type_name("FILE");
  run->add_option("--plant", options.plant,
                  "Plant to drive (default: bullet):" + plant_type_docs() + "; or a plug-in's")
      ->type_name("TYPE");
  run->add_option("--peer", options.peer, "Address of the drives, or of `kadans plant` (default: the configuration's)")
      ->type_name("HOST:PORT");
  run->add_option("--imu", options.imu, "Serial port of the IMU beside the drives (default: the configuration's)")
      ->type_name("FILE");
  run->add_flag("--read-only", options.read_only, "Read every sensor, and ask nothing of the drives: none is enabled");
  run->add_option("--play", options.play,
                  "Behaviors to play: \"squat, wave\" (default: none, the robot holds its position)")
      ->type_name("LIST");
  run->add_option(
         "--joystick", options.joystick,
         "Joystick that behaviors read as s.joystick: a device such as /dev/input/event5, or a recording of one")
      ->type_name("FILE");
  add_number(*run, "--duration", options.duration_s, 0.001, 1e9, "S",
             "Seconds to run (default: until SIGINT or SIGTERM)");
  run->add_option("--record", options.record,
                  "Write a record to this file, or to numbered files in this folder (default: none)")
      ->type_name("PATH");
  add_record_options(*run, options.recording);
  add_number(*run, "--records-max", options.recording.folder_MB, 0.0, 1e7, "MB",
             "Room for numbered records and those of the flight recorder; the oldest go (default: the robot's "
             "record.folder_MB; 0: no bound)");
  add_seed(*run, options.seed, "Seed of a model's random numbers (default: 1)");
  run->add_flag("--soft", options.soft, "Run even without the rights that real time needs");
  run->add_flag("--threads-on-virtual-time", options.virtual_time,
                "Run the same threads on virtual time, which waits for all of them");
  CLI::Option* sleep = run->add_flag("--sleep-only", options.sleep_only, "Sleep until the next tick, without spinning");
  add_number(*run, "--spin-us", options.spin_us, 1.0, 900.0, "US", "Time to spin after sleeping")->excludes(sleep);
  run->add_flag("!--no-keep-awake", options.keep_awake, "Let the control thread's CPU idle between the ticks");
  add_whole(*run, "--cpu", options.cpu, 0, 1023, "CPU of the control thread (default: an isolated one, else the last)");
  run->add_option("--behaviors", options.behaviors,
                  "Play behaviors in a thread (default), or in a process of their own, which may die")
      ->check(CLI::IsMember({"thread", "process"}));
  run->add_option(
         "--decisions", options.decisions,
         "Run the supervisor's decisions in its thread, or in a process of their own (default: as --behaviors)")
      ->check(CLI::IsMember({"thread", "process"}));
  add_number(*run, "--behaviors-patience", options.behaviors_patience_s, 0.01, 1000.0, "S",
             "Time without an answer after which such a process is killed (default: 0.3; on virtual time 10)");
  add_whole(*run, "--behaviors-deaths", options.behaviors_deaths, 1, 1'000'000'000,
            "Deaths in a row after which such a process is not started again (default: 8)");
  add_number(*run, "--behaviors-memory", options.behaviors_memory_MB, 1.0, 1e6, "MB",
             "Memory that such a process may take in addition to what it has when it begins to play (default: 256)");
  add_services(*run, options);
  run->add_flag("--json", options.json, "Print one JSON object instead of text");
  run->add_flag("-v,--verbose", options.verbose, "Show what the behaviors log and their transitions");
  run->add_option("--log-file", options.log_file, "Append all log lines to this file, transitions too (default: none)")
      ->type_name("FILE");
}

}  // namespace kadans
