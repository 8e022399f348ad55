// `kadans jog`: moves one joint at a low torque while a key is held. Whatever ends the keys ends the torque: letting
// go, another key, a terminal that is gone, a signal; and when this program dies, the drives' own watchdog.
#include <cerrno>
#include <cstdio>
#include <ctime>

#include <CLI/CLI.hpp>
#include <fcntl.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include "app/assembly.h"
#include "app/author/file_checks.h"
#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "jog.h"
#include "kadans/plant/plant_type.h"
#include "signal/monotonic_clock.h"
#include "signal/nearest_name.h"

namespace kadans {
namespace {

constexpr double stop_margin_rad = 0.05;
constexpr std::int64_t told_every_ns = 100'000'000;

// Keys from the standard input, one by one and without waiting, while it lives.
class Keys {
 public:
  Keys() : flags_(fcntl(STDIN_FILENO, F_GETFL)) {
    is_terminal_ = tcgetattr(STDIN_FILENO, &before_) == 0;
    if (is_terminal_) {
      termios raw = before_;
      raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
      raw.c_cc[VMIN] = 0;
      raw.c_cc[VTIME] = 0;
      (void)tcsetattr(STDIN_FILENO, TCSANOW, &raw);
    }
    (void)fcntl(STDIN_FILENO, F_SETFL, flags_ | O_NONBLOCK);
  }
  ~Keys() {
    (void)fcntl(STDIN_FILENO, F_SETFL, flags_);
    if (is_terminal_) (void)tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  bool is_terminal() const noexcept { return is_terminal_; }
  // The newest key; 0: none. `gone`: nobody can press one any more.
  char newest(bool& gone) noexcept {
    char keys[64];
    pollfd here{STDIN_FILENO, POLLIN, 0};
    (void)poll(&here, 1, 0);
    const ssize_t got = read(STDIN_FILENO, keys, sizeof keys);
    // A terminal without a key reads as 0 bytes, too.
    const bool hung_up = (here.revents & (POLLHUP | POLLERR | POLLNVAL)) != 0;
    gone = got <= 0 && (hung_up || (got == 0 && !is_terminal_) || (got < 0 && errno != EAGAIN && errno != EINTR));
    return got > 0 ? keys[got - 1] : '\0';
  }

 private:
  int flags_;
  bool is_terminal_ = false;
  termios before_{};
};

class JogRun {
 public:
  explicit JogRun(const JogOptions& options) : options_(options), robot_(read_robot(options.robot)) {
    const RobotModel& model = robot_.config.model;
    const std::vector<std::string> names = model.joint_names();
    const auto found = model.find_joint(options.joint);
    if (!found) {
      throw InputError(
          {.file = options.robot,
           .message = "the robot has no joint '" + options.joint + "'" + did_you_mean(options.joint, names)});
    }
    const Joint& joint = model.joints[*found];
    if (joint.passive())
      throw InputError(
          {.file = options.robot, .message = "joint '" + options.joint + "' is passive: nothing moves it"});
    settings_ = {.joint = *found,
                 .torque_Nm = options.share * joint.effort_max_Nm,
                 .velocity_max_rad_s = options.speed_rad_s,
                 .lower_rad = joint.lower_rad + stop_margin_rad,
                 .upper_rad = joint.upper_rad - stop_margin_rad};
    const PlantType& type = plant_type_named(robot_.config, "--plant", {options.plant, {}});
    words_ = type.drive_words();
    try {
      if (type.is_model()) {
        world_ = type.make_world({model, robot_.config.plant, 1});
      } else {
        plant_ = make_bus(robot_.config, type, options.peer, options.imu);
      }
    } catch (const std::invalid_argument& error) {
      throw InputError({.file = options.robot, .message = error.what()});
    }
  }

  int run() {
    Plant& plant = world_ ? static_cast<Plant&>(world_->robot(0)) : *plant_;
    if (!plant.open(interrupted)) return exit_interrupted;
    std::fprintf(stderr, "%s: hold l or h to push it with %.3g Nm, either way; q ends\n", options_.joint.c_str(),
                 settings_.torque_Nm);
    const std::string ended = loop(plant);
    plant.write(nothing());
    plant.close();
    std::printf("%s: from %.4f to %.4f rad; %s\n", options_.joint.c_str(), first_rad_, last_rad_, ended.c_str());
    return failed_ ? exit_failed : exit_passed;
  }

 private:
  std::string loop(Plant& plant) {
    const std::int64_t period_ns = robot_.config.engine.control_period_ns();
    Keys keys;
    Jog jog(settings_);
    std::int64_t due_ns = monotonic_ns(), told_ns = due_ns;
    for (bool first = true;; first = false) {
      plant.read(sensors_);
      last_rad_ = sensors_.joints[settings_.joint].position_rad;
      if (first) first_rad_ = last_rad_;
      const std::int64_t now_ns = monotonic_ns();
      bool gone = false;
      const char key = keys.newest(gone);
      if (gone) return "the keys are gone";
      if (interrupted()) return "told to stop";
      if (key == 'q') return "ended";
      if (key != '\0') jog.key(key == 'l' ? 1 : key == 'h' ? -1 : 0, now_ns);
      jog.step(sensors_, now_ns, actuation_);
      plant.write(actuation_);
      if (world_) world_->step(period_ns);
      if (jog.stopped() != Jog::Stop::none) return why(jog.stopped());
      if (keys.is_terminal() && now_ns - told_ns >= told_every_ns) {
        told_ns = now_ns;
        std::fprintf(stderr, "\r%9.4f rad  %-8s", last_rad_, jog.pushes() ? "pushes" : "free");
      }
      due_ns = std::max(due_ns + period_ns, now_ns - period_ns);
      const timespec until{.tv_sec = static_cast<time_t>(due_ns / ns_per_s), .tv_nsec = due_ns % ns_per_s};
      clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    }
  }

  std::string why(Jog::Stop stop) {
    failed_ = true;
    const JointSample& joint = sensors_.joints[settings_.joint];
    if (stop == Jog::Stop::silent) return "stopped: it tells nothing any more";
    if (stop == Jog::Stop::too_fast) return "stopped: it moves faster than it is pushed";
    std::string words = "stopped: its drive has a fault, code " + std::to_string(joint.code);
    if (words_ != nullptr) words += ": " + std::string(words_(joint.code));
    return words;
  }
  const ActuationFrame& nothing() {
    for (JointActuation& one : actuation_.joints) one = {};
    return actuation_;
  }

  const JogOptions& options_;
  Robot robot_;
  Jog::Settings settings_;
  DriveWords words_ = nullptr;
  std::unique_ptr<World> world_;
  std::unique_ptr<Plant> plant_;
  SensorFrame sensors_;
  ActuationFrame actuation_;
  double first_rad_ = 0, last_rad_ = 0;
  bool failed_ = false;
};

}  // namespace

void add_jog(CLI::App& app, JogOptions& options) {
  CLI::App* jog = app.add_subcommand("jog", "Move one joint at a low torque while a key is held; all others are off");
  jog->add_option("robot", options.robot, "The robot's configuration (JSON)")->required()->type_name("FILE");
  jog->add_option("joint", options.joint, "The joint")->required()->type_name("NAME");
  jog->add_option("--plant", options.plant, "Plant to drive (default: bullet, its model)")->type_name("TYPE");
  jog->add_option("--imu", options.imu, "Serial port of the IMU (default: the configuration's)")->type_name("FILE");
  jog->add_option("--peer", options.peer, "Address of the drives (default: the configuration's)")
      ->type_name("HOST:PORT");
  jog->add_option("--share", options.share, "Torque, as a share of the joint's greatest (default: 0.1)")
      ->type_name("X")
      ->check(number_within(0.001, 0.5));
  jog->add_option("--speed", options.speed_rad_s, "Speed in rad/s at which no torque is left (default: 0.5)")
      ->type_name("X")
      ->check(number_within(0.01, 10.0));
}

int run_jog(const JogOptions& options) {
  require_kind(options.robot, JsonKind::robot);
  JogRun run(options);
  catch_interrupts();
  return run.run();
}

}  // namespace kadans
