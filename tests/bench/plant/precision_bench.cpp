// Work and precision: how far a robot's links are from where a small step leads, over the processor's time that the
// steps take. Each engine is measured against itself at a thirty-second of a millisecond, for their models of contact
// differ: so this is the error of the step, not that of the model. The motions: standing; walking, the joint positions
// of the walk scenario's first seconds played open loop; falling, the ankles pushed until the robot lies; free flight,
// tumbling with waving joints. The torques are those of a PD rule with a period of 2 ms, whatever the step. Links touch
// the ground alone, in every engine.
//
// TULip, and the robot of KADANS_PRECISION_ROBOT, a robot.json: what `kadans new robot` writes of the G1's URDF, for
// example. The rows go to precision.csv, the picture to precision.png, in KADANS_PRECISION_FOLDER (default: here).
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <functional>
#include <numbers>
#include <optional>

#include "../report.h"
#include "app/assembly/assembly.h"
#include "engines.h"
#include "kadans/model/kinematics.h"
#include "standing.h"

namespace kadans::bench {
namespace {

constexpr std::int64_t control_ns = 2'000'000, sample_ns = 10'000'000, reference_ns = 31'250;
constexpr std::int64_t steps_ns[] = {2'000'000, 1'000'000, 500'000, 250'000, 125'000};

using Targets = std::function<std::vector<double>(double time_s)>;

struct Gains {
  double stiffness_Nm_per_rad, damping_Nms_per_rad, torque_max_Nm;
};

struct Subject {
  std::string name;
  RobotModel model;
  PlantSettings standing;
  std::vector<Gains> gains;
};

struct Motion {
  std::string name;
  double duration_s;
  PlantSettings settings;
  Targets targets;
};

using MakeEngine = std::function<std::unique_ptr<Engine>(const PlantSettings&, std::int64_t step_ns)>;

struct Way {
  std::vector<Vec3> links_m;  // of each sample all links
  double us_per_ms = 0;       // of the processor, for a simulated millisecond
};

double processor_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

std::vector<double> torques(const Subject& subject, const std::vector<double>& target_rad, const EngineState& state) {
  std::vector<double> torque_Nm;
  for (std::size_t i = 0; i < target_rad.size(); ++i) {
    const Gains& gains = subject.gains[i];
    const double wanted_Nm = gains.stiffness_Nm_per_rad * (target_rad[i] - state.position_rad[i]) -
                             gains.damping_Nms_per_rad * state.velocity_rad_s[i];
    torque_Nm.push_back(std::clamp(wanted_Nm, -gains.torque_max_Nm, gains.torque_max_Nm));
  }
  return torque_Nm;
}

Way way_of(const Subject& subject, const Motion& motion, const MakeEngine& make, std::int64_t step_ns) {
  const auto engine = make(motion.settings, step_ns);
  Kinematics kinematics(subject.model);
  Way way;
  const auto end_ns = static_cast<std::int64_t>(1e9 * motion.duration_s);
  double used_us = 0;
  for (std::int64_t time_ns = 0; time_ns < end_ns; time_ns += control_ns) {
    const double time_s = 1e-9 * static_cast<double>(time_ns);
    engine->set_torques(torques(subject, motion.targets(time_s), engine->state()));
    const double began_us = processor_us();
    for (std::int64_t i = 0; i < control_ns / step_ns; ++i) engine->step();
    used_us += processor_us() - began_us;
    if ((time_ns + control_ns) % sample_ns != 0) continue;
    const EngineState state = engine->state();
    kinematics.update(state.position_rad, state.base);
    for (std::size_t i = 0; i < subject.model.links.size(); ++i) {
      way.links_m.push_back(kinematics.link(i).position_m);
    }
  }
  way.us_per_ms = used_us / (1e3 * motion.duration_s);
  return way;
}

double apart_mm(const Way& a, const Way& b) {
  double sum_m = 0;
  for (std::size_t i = 0; i < a.links_m.size(); ++i) {
    const Vec3 &p = a.links_m[i], &q = b.links_m[i];
    sum_m += std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
  }
  return 1e3 * sum_m / static_cast<double>(a.links_m.size());
}

Subject tulip() {
  StandingRobot robot = standing_tulip();
  Subject subject{"TULip", std::move(robot.model), std::move(robot.settings), {}};
  subject.standing.self_collision = false;
  for (const Joint& joint : subject.model.joints) subject.gains.push_back({300, 4, joint.effort_max_Nm});
  return subject;
}

// Whatever a drive of it is, here it is rigid, as MuJoCo knows them.
Subject robot_of(const std::string& file) {
  Robot robot = read_robot(file);
  Subject subject{robot.config.model.name, robot.config.model, {}, {}};
  PlantSettings& settings = subject.standing;
  settings.self_collision = false;
  settings.feet = robot.config.plant.feet;
  settings.passing = robot.config.plant.passing;
  settings.position_rad = robot.config.plant.position_rad;
  settings.base = robot.config.plant.base;
  settings.encoders.resize(subject.model.joints.size());
  for (std::size_t i = 0; i < subject.model.joints.size(); ++i) {
    const DriveSettings& drive = robot.config.plant.drives[i];
    settings.drives.push_back({.torque_max_Nm = drive.torque_max_Nm,
                               .rotor_inertia_kg_m2 = std::max(drive.rotor_inertia_kg_m2, 0.01),
                               .viscous_Nms_per_rad = std::max(drive.viscous_Nms_per_rad, 0.1)});
    subject.gains.push_back({3 * drive.torque_max_Nm, 0.04 * drive.torque_max_Nm, drive.torque_max_Nm});
  }
  for (const Link& link : subject.model.links) settings.surfaces.push_back({link.name, 0.8});
  put_on_ground(subject.model, settings);
  return subject;
}

// The joints' positions in each control tick of the walk scenario.
class Positions final : public RunObserver {
 public:
  Positions(const SignalTable& signals, const RobotModel& model) {
    for (const Joint& joint : model.joints) {
      const auto id = signals.find("joint." + joint.name + ".position_rad");
      if (!id) throw std::runtime_error("no signal of joint " + joint.name);
      ids_.push_back(*id);
    }
  }
  void tick(double, std::span<const double> row) override {
    std::vector<double>& tick = ticks_.emplace_back();
    for (const std::size_t id : ids_) tick.push_back(row[id]);
  }
  std::vector<std::vector<double>> take() { return std::move(ticks_); }

 private:
  std::vector<std::size_t> ids_;
  std::vector<std::vector<double>> ticks_;
};

Motion walking(const Subject& subject, double duration_s) {
  RunLog log;
  const ScenarioConfig scenario = read_scenario_config(KADANS_SOURCE_DIR "/config/scenarios/walk.json");
  Assembly robot(scenario, 1, log);
  Positions positions(robot.catalog().signals, subject.model);
  std::vector<RunObserver*> observers{&positions};
  Checks checks(robot.catalog().signals);
  const RunParts parts = robot.parts();
  (void)run_scenario(parts, duration_s, checks, observers);
  Motion motion{"walking", duration_s, subject.standing, {}};
  const auto ticks = positions.take();
  motion.settings.position_rad = ticks.front();
  motion.settings.stand_on_ground = true;
  motion.settings.base.orientation = {1, 0, 0, 0};
  put_on_ground(subject.model, motion.settings);
  motion.targets = [ticks](double time_s) {
    return ticks[std::min(static_cast<std::size_t>(std::lround(1e3 * time_s)), ticks.size() - 1)];
  };
  return motion;
}

std::vector<Motion> motions_of(const Subject& subject) {
  const std::vector<double> held = subject.standing.position_rad;
  std::vector<Motion> motions;
  motions.push_back({"standing", 1, subject.standing, [held](double) { return held; }});
  if (subject.name == "TULip") motions.push_back(walking(subject, 2));
  std::vector<double> pushed = held;
  for (std::size_t i = 0; i < held.size(); ++i) {
    if (subject.model.joints[i].name.find("ankle_pitch") != std::string::npos) pushed[i] += 0.4;
  }
  motions.push_back({"falling", 1.6, subject.standing, [pushed](double) { return pushed; }});
  Motion flight{"free flight", 0.5, subject.standing, {}};
  flight.settings.base.position_m[2] += 2;
  flight.targets = [held](double time_s) {
    std::vector<double> waved = held;
    for (std::size_t i = 0; i < held.size(); ++i)
      waved[i] += 0.4 * std::sin(4 * std::numbers::pi * time_s + static_cast<double>(i));
    return waved;
  };
  motions.push_back(std::move(flight));
  return motions;
}

struct Row {
  std::string robot, motion, engine;
  std::int64_t step_ns;
  double error_mm, us_per_ms;
};

// Nothing where the engine gives up at this step.
std::optional<Way> tried_way(const Subject& subject, const Motion& motion, const MakeEngine& make,
                             std::int64_t step_ns) {
  try {
    return way_of(subject, motion, make, step_ns);
  } catch (const std::runtime_error&) {
    return std::nullopt;
  }
}

void measure(const Subject& subject, std::vector<Row>& rows) {
  const std::pair<std::string, MakeEngine> engines[] = {
      {"Kadans",
       [&](const PlantSettings& settings, std::int64_t step_ns) {
         return kadans_engine(subject.model, settings, ContactSolver::tree, step_ns);
       }},
      {"MuJoCo CG", [&](const PlantSettings& settings,
                        std::int64_t step_ns) { return mujoco_engine(subject.model, settings, "CG", step_ns); }},
      {"MuJoCo Newton",
       [&](const PlantSettings& settings, std::int64_t step_ns) {
         return mujoco_engine(subject.model, settings, "Newton", step_ns);
       }},
      {"MuJoCo Newton RK4", [&](const PlantSettings& settings, std::int64_t step_ns) {
         return mujoco_engine(subject.model, settings, "Newton", step_ns, "RK4");
       }}};
  for (const Motion& motion : motions_of(subject)) {
    for (const auto& [engine, make] : engines) {
      const std::optional<Way> reference = tried_way(subject, motion, make, reference_ns);
      if (!reference) continue;
      for (const std::int64_t step_ns : steps_ns) {
        const std::optional<Way> way = tried_way(subject, motion, make, step_ns);
        if (way)
          rows.push_back({subject.name, motion.name, engine, step_ns, apart_mm(*way, *reference), way->us_per_ms});
      }
    }
  }
}

void write_table(const std::vector<Row>& rows, const std::string& file) {
  std::ofstream out(file);
  out << "robot,motion,engine,step_ms,error_mm,us_per_ms\n";
  for (const Row& row : rows) {
    out << row.robot << ',' << row.motion << ',' << row.engine << ',' << 1e-6 * static_cast<double>(row.step_ns) << ','
        << row.error_mm << ',' << row.us_per_ms << '\n';
  }
  if (!out.flush()) throw std::runtime_error(file + " cannot be written");
}

// A panel for each robot and motion, a line for each engine, a mark for each step.
void draw(const std::vector<Row>& rows, const std::string& file) {
  std::vector<std::pair<std::string, std::vector<const Row*>>> panels;
  for (const Row& row : rows) {
    const std::string title = row.robot + ", " + row.motion;
    if (panels.empty() || panels.back().first != title) panels.push_back({title, {}});
    panels.back().second.push_back(&row);
  }
  std::FILE* const plot = popen("gnuplot -d", "w");
  if (plot == nullptr) throw std::runtime_error("gnuplot cannot be started");
  const std::size_t lines = (panels.size() + 1) / 2;
  std::fprintf(plot, "set terminal pngcairo size 1000,%zu font 'sans,10'\nset output '%s'\n", 330 * lines,
               file.c_str());
  std::fprintf(plot, "set multiplot layout %zu,2\nset logscale xy\nset grid\nset format y '10^{%%L}'\n", lines);
  std::fputs("set xlabel 'processor, us a simulated ms'\nset ylabel 'error, mm'\nset key bottom left\n", plot);
  for (const auto& [title, panel] : panels) {
    std::string curves;
    for (std::size_t i = 0; i < panel.size(); ++i) {
      if (i > 0 && panel[i]->engine == panel[i - 1]->engine) continue;
      curves += std::string(curves.empty() ? "plot" : ",") + " '-' with linespoints lw 2 pt 7 title '" +
                panel[i]->engine + "'";
    }
    std::fprintf(plot, "set title '%s' noenhanced\n%s\n", title.c_str(), curves.c_str());
    for (std::size_t i = 0; i < panel.size(); ++i) {
      std::fprintf(plot, "%g %g\n", panel[i]->us_per_ms, std::max(panel[i]->error_mm, 1e-9));
      if (i + 1 == panel.size() || panel[i + 1]->engine != panel[i]->engine) std::fputs("e\n", plot);
    }
  }
  std::fputs("unset multiplot\n", plot);
  if (pclose(plot) != 0) throw std::runtime_error("gnuplot failed");
}

}  // namespace

void bench_precision(Report& report) {
  std::vector<Row> rows;
  measure(tulip(), rows);
  if (const char* robot = std::getenv("KADANS_PRECISION_ROBOT"); robot != nullptr) measure(robot_of(robot), rows);
  for (const Row& row : rows) {
    if (row.step_ns != 1'000'000) continue;
    const std::string of = row.robot + "." + row.motion + "." + row.engine, text = row.motion + ", " + row.engine;
    report.add("precision_mm." + of, row.robot + " " + text + ", error of 1 ms steps", row.error_mm, "mm");
    report.add("precision_us." + of, "  its cost", row.us_per_ms, "us");
  }
  const char* const given = std::getenv("KADANS_PRECISION_FOLDER");
  const std::string folder = given == nullptr ? "." : given;
  write_table(rows, folder + "/precision.csv");
  draw(rows, folder + "/precision.png");
}

}  // namespace kadans::bench
