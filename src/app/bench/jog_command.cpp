// `kadans jog`: moves one joint at a low torque while a key is held. Whatever ends the keys ends the torque: letting
// go, another key, a terminal that is gone, a signal; and when this program dies, the drives' own watchdog.
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "app/assembly/robot.h"
#include "app/author/file_checks.h"
#include "app/commands.h"
#include "app/option_checks.h"
#include "app/terminal.h"
#include "drive_bench.h"
#include "jog.h"
#include "kadans/signal/nearest_name.h"
#include "keys.h"

namespace kadans {
namespace {

struct JogOptions {
  std::string robot, joint;
  std::string plant = "bullet";
  std::string peer;          // address of the drives; "": the robot's own
  std::string imu;           // serial port of the IMU beside them; "": the robot's own
  double share = 0.1;        // of the joint's greatest torque
  double speed_rad_s = 0.5;  // at which none is left
};

constexpr double stop_margin_rad = 0.05;
constexpr std::int64_t told_every_ns = 100'000'000;

class JogRun {
 public:
  explicit JogRun(const JogOptions& options) : options_(options), robot_(read_robot(options.robot)) {
    const RobotModel& model = robot_.config.model;
    const std::vector<std::string> names = model.joint_names();
    const auto found = model.find_joint(options.joint);
    if (!found) {
      refuse(options.robot, "the robot has no joint '" + options.joint + "'" + did_you_mean(options.joint, names));
    }
    const Joint& joint = model.joints[*found];
    if (joint.passive()) refuse(options.robot, "joint '" + options.joint + "' is passive: nothing moves it");
    settings_ = {.joint = *found,
                 .torque_Nm = options.share * joint.effort_max_Nm,
                 .velocity_max_rad_s = options.speed_rad_s,
                 .lower_rad = joint.lower_rad + stop_margin_rad,
                 .upper_rad = joint.upper_rad - stop_margin_rad};
    bench_ = std::make_unique<DriveBench>(robot_, options.plant, options.peer, options.imu);
  }

  int run() {
    if (!bench_->open()) return exit_interrupted;
    std::fprintf(stderr, "%s: hold l or h to push it with %.3g Nm, either way; q ends\n", options_.joint.c_str(),
                 settings_.torque_Nm);
    const std::string ended = loop();
    bench_.reset();
    std::printf("%s: from %.4f to %.4f rad; %s\n", options_.joint.c_str(), first_rad_, last_rad_, ended.c_str());
    return failed_ ? exit_failed : exit_passed;
  }

 private:
  std::string loop() {
    Keys keys;
    Jog jog(settings_);
    std::int64_t told_ns = bench_->now_ns();
    for (bool first = true;; first = false) {
      bench_->read(sensors_);
      last_rad_ = sensors_.joints[settings_.joint].position_rad;
      if (first) first_rad_ = last_rad_;
      const std::int64_t now_ns = bench_->now_ns();
      bool gone = false;
      const std::string_view pressed = keys.pressed(gone);
      const char key = pressed.empty() ? '\0' : pressed.back();
      if (gone) return "the keys are gone";
      if (interrupted()) return "told to stop";
      if (key == 'q') return "ended";
      if (key != '\0') jog.key(key == 'l' ? 1 : key == 'h' ? -1 : 0, now_ns);
      jog.step(sensors_, now_ns, actuation_);
      bench_->write(actuation_);
      if (jog.stopped() != Jog::Stop::none) return why(jog);
      if (keys.is_terminal() && now_ns - told_ns >= told_every_ns) {
        told_ns = now_ns;
        std::fprintf(stderr, "\r%9.4f rad  %-8s", last_rad_, jog.pushes() ? "pushes" : "free");
      }
    }
  }

  std::string why(const Jog& jog) {
    failed_ = true;
    if (jog.stopped() == Jog::Stop::too_fast) return "stopped: it moves faster than it is pushed";
    return "stopped: its drive " +
           stop_words(jog.drive_stopped(), sensors_.joints[settings_.joint].code, bench_->words());
  }

  const JogOptions& options_;
  Robot robot_;
  Jog::Settings settings_;
  std::unique_ptr<DriveBench> bench_;
  SensorFrame sensors_;
  ActuationFrame actuation_;
  double first_rad_ = 0, last_rad_ = 0;
  bool failed_ = false;
};

int run_jog(const JogOptions& options) {
  require_kind(options.robot, JsonKind::robot);
  JogRun run(options);
  catch_interrupts();
  return run.run();
}

}  // namespace

void add_jog(CommandLine& line) {
  const auto [jog, options] =
      line.add<JogOptions>("jog", "Move one joint at a low torque while a key is held; all others are off", run_jog);
  jog->add_option("robot", options.robot, "The robot's configuration (JSON)")->required()->type_name("FILE");
  jog->add_option("joint", options.joint, "The joint")->required()->type_name("NAME");
  jog->add_option("--plant", options.plant, "Plant to drive (default: bullet, its model)")->type_name("TYPE");
  jog->add_option("--imu", options.imu, "Serial port of the IMU (default: the configuration's)")->type_name("FILE");
  jog->add_option("--peer", options.peer, "Address of the drives (default: the configuration's)")
      ->type_name("HOST:PORT");
  add_number(*jog, "--share", options.share, 0.001, 0.5, "X",
             "Torque, as a share of the joint's greatest (default: 0.1)");
  add_number(*jog, "--speed", options.speed_rad_s, 0.01, 10.0, "X",
             "Speed in rad/s at which no torque is left (default: 0.5)");
}

}  // namespace kadans
