// `kadans new robot`: from a URDF to a robot that stands or is held, with all of its files.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <tinyxml2.h>

#include "app/author/robot_description.h"
#include "app/author/stance.h"
#include "app/live/record_pictures.h"
#include "app/terminal.h"
#include "config/json/foreign_json.h"
#include "config/robot/mesh_hull.h"
#include "kadans/model/urdf.h"
#include "kadans/plant/bullet/bullet_world.h"
#include "kadans/signal/input_error.h"
#include "kadans/signal/shell_word.h"
#include "model/xml_scan.h"
#include "new_files.h"
#include "signal/input_file.h"
#include "signal/number_text.h"

namespace kadans {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct NewRobotOptions {
  std::string urdf, srdf, name;
  std::vector<std::string> packages;  // NAME=FOLDER
  std::string folder = ".";           // the project
  bool no_run = false;
};

constexpr std::string_view sway_template =
    R"(-- Goes from one pose to another and back, a few times. Change it and run it again.
local k = require "kadans"

local P = k.params {
  move_s  = { 2.0, min = 0.5, max = 20, unit = "s", doc = "time from one pose to the other" },
  rest_s  = { 0.5, min = 0, max = 20, unit = "s", doc = "time to stay there" },
  repeats = { 2, min = 1, max = 100, doc = "how often" },
}

return k.behavior "sway" {
  controls = "hold",
  vars     = { done = 0 },
  initial  = "sway",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" and s.safety.level ~= "limited" end, to = "failed", why = "safety" },
  },

  k.state "sway" {
    run = function(m)
      while m.vars.done < P.repeats do
        m.posture:move("low", { time_s = P.move_s }):wait()
        m:wait(P.rest_s)
        m.posture:move("stand", { time_s = P.move_s }):wait()
        m:wait(P.rest_s)
        m.vars.done = m.vars.done + 1
      end
    end,
    { on = "run.done", to = "done" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}
)";

constexpr std::string_view roll_template =
    R"(-- Rolls forward and back, a few times. Change it and run it again.
local k = require "kadans"

local P = k.params {
  rate_rad_s = { @rate@, min = -@most@, max = @most@, unit = "rad/s", doc = "how fast the wheels turn" },
  roll_s     = { 2.0, min = 0.1, max = 60, unit = "s", doc = "time to roll one way" },
  ramp_s     = { 0.5, min = 0.05, max = 10, unit = "s", doc = "time to change the velocity" },
  repeats    = { 1, min = 1, max = 100, doc = "how often" },
}

-- The wheels, and which way each turns to roll along x; 0: across.
local wheels = { @wheels@ }

local function roll(m, rate_rad_s, time_s)
  for _, wheel in ipairs(wheels) do
    m.wheels:set(wheel.name .. ".velocity_rad_s", wheel.forward * rate_rad_s, { time_s = P.ramp_s })
  end
  m:wait(time_s)
end

return k.behavior "roll" {
  controls = "hold",
  vars     = { done = 0 },
  initial  = "roll",
  always   = {
    { when = function(s) return s.safety.level ~= "normal" and s.safety.level ~= "limited" end, to = "failed", why = "safety" },
  },

  k.state "roll" {
    run = function(m)
      while m.vars.done < P.repeats do
        roll(m, P.rate_rad_s, P.roll_s)
        roll(m, 0, 2 * P.ramp_s)
        roll(m, -P.rate_rad_s, P.roll_s)
        roll(m, 0, 2 * P.ramp_s)
        m.vars.done = m.vars.done + 1
      end
    end,
    exit = function(m) m.wheels:hold() end,
    { on = "run.done", to = "done" },
  },
  k.final "done"   { outcome = "done" },
  k.final "failed" { outcome = "failed" },
}
)";

constexpr std::string_view motion_test_template = R"(-- kadans behavior test behaviors/@name@/@behavior@_test.lua
local k = require "kadans"

describe("@behavior@", function()
  it("goes there and back as often as it is told", function()
    local run = k.play("@behavior@.lua", { plant = "bullet" })
    run:set_parameter("repeats", 1)
    expect(run:finish(30)).to_equal "done"
  end)
end)
)";

double rounded(double value, double to = 1e-4) { return std::round(value / to) / std::round(1 / to); }
double figures(double value) {  // three
  if (!(value > 0)) return 0;
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::round(value / unit) * unit;
}

std::string name_from(const std::string& text) {
  std::string name;
  for (const char c : text) {
    const char lower = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool good = (lower >= 'a' && lower <= 'z') || (lower >= '0' && lower <= '9');
    if (good) {
      name += lower;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  while (!name.empty() && name.back() == '_') name.pop_back();
  return name;
}

// What an attribute's text stands for, its entities read.
std::string xml_value(const std::string& written) {
  const char quote = written.find('"') == std::string::npos ? '"' : '\'';
  tinyxml2::XMLDocument document;
  if (document.Parse(("<value is=" + (quote + written + quote) + "/>").c_str()) != tinyxml2::XML_SUCCESS)
    return written;
  return document.RootElement()->Attribute("is");
}
// Without what XML, URIs and shells have a meaning for.
std::string plain_name(std::string name) {
  for (char& c : name) {
    if (static_cast<unsigned char>(c) < 0x80 && std::isalnum(static_cast<unsigned char>(c)) == 0 &&
        std::string_view("._-+").find(c) == std::string_view::npos)
      c = '_';
  }
  return name;
}

// The URDF's text with its meshes in a folder beside it; `copies` gets the name there of each mesh's file.
std::string with_own_meshes(const std::string& text, const std::string& file, const UrdfPackages& packages,
                            std::map<std::string, std::string>& copies) {
  std::string result;
  std::set<std::string> taken;
  std::size_t at = 0;
  const SourceText source(text);
  for (const XmlTag& tag : scan_xml(source).tags) {
    for (const XmlAttribute& attribute : tag.attributes) {
      if (attribute.name != "filename") continue;
      const std::size_t close = text.find(text[attribute.value_at - 1], attribute.value_at);
      const std::string written = text.substr(attribute.value_at, close - attribute.value_at);
      const std::optional<std::string> there = find_urdf_file(xml_value(written), file, packages);
      if (!there) continue;
      std::string& copy = copies[*there];
      if (copy.empty()) {
        const fs::path path(*there);
        const std::string stem = plain_name(path.stem().string()), extension = plain_name(path.extension().string());
        copy = stem + extension;
        for (int i = 2; taken.contains(copy); ++i) copy = stem + "_" + std::to_string(i) + extension;
        taken.insert(copy);
      }
      result += text.substr(at, attribute.value_at - at) + "meshes/" + copy;
      at = close;
    }
  }
  return result + text.substr(at);
}

Json pose_json(const RobotModel& model, const std::vector<double>& position) {
  Json pose = Json::object();
  for (std::size_t i = 0; i < position.size(); ++i) {
    const Joint& joint = model.joints[i];
    pose[joint.name] = std::clamp(rounded(position[i]), joint.lower_rad, joint.upper_rad);  // keyframes lie beyond, too
  }
  return pose;
}

// The two that are worked out, and those of an MJCF's keyframes.
Json poses_json(const RobotDescription& robot, const StandingPose& stance) {
  Json poses = {{"stand", pose_json(robot.model, stance.stand)}, {"low", pose_json(robot.model, stance.low)}};
  for (const MjcfPose& key : robot.poses) {
    std::string name = name_from(key.name);
    if (name.empty() || poses.contains(name)) name = "key_" + name;
    std::vector<double> position(robot.model.joints.size());
    for (const auto& [joint, at] : key.position) {
      if (const auto number = robot.model.find_joint(joint)) position[*number] = at;
    }
    poses[name] = pose_json(robot.model, position);
  }
  return poses;
}

// An SRDF with the pairs of links that touch in the poses and not at 0, where their hulls are larger than they are; ""
// without such.
std::string touching_srdf(const RobotModel& model, const std::string& name, const StandingPose& stance) {
  PlantSettings settings;
  settings.drives.resize(model.joints.size());
  settings.encoders.resize(model.joints.size());
  std::set<std::pair<std::string, std::string>> pairs;
  for (const std::vector<double>* position : {&stance.stand, &stance.low}) {
    settings.position_rad = *position;
    for (auto& pair : touching_links(model, settings, TouchingAt::start)) pairs.insert(std::move(pair));
  }
  if (pairs.empty()) return "";
  std::string text = "<robot name=\"" + name + "\">\n";
  for (const auto& [first, second] : pairs)
    text += "  <disable_collisions link1=\"" + first + "\" link2=\"" + second +
            "\" reason=\"Touching in stand or low\"/>\n";
  return text + "</robot>\n";
}

Json feet_json(const RobotModel& model, const StandingPose& stance) {
  constexpr const char* corners[] = {"heel_inner_m", "heel_outer_m", "toe_inner_m", "toe_outer_m"};
  Json feet = Json::array();
  for (const StandingFoot& foot : stance.feet) {
    Json& written =
        feet.emplace_back(Json{{"name", foot.name}, {"link", model.links[foot.link].name}, {"noise_N", 0.5}});
    for (std::size_t i = 0; i < std::size(corners); ++i) {
      for (const double at_m : foot.corners_m[i]) written[corners[i]].push_back(rounded(at_m));
    }
  }
  return feet;
}

// Two legs balance by their ankles, and by the trunk where these do not suffice. Gains by the robot's m g h, as TULip's
// are.
Json balance_json(const RobotModel& model, const StandingPose& stance) {
  constexpr double edge_m = 0.01, most_Nm_per_rad = 2000, most_Nms_per_rad = 200;
  const StandingFoot &left = stance.feet[0], &right = stance.feet[1];
  Json joints = Json::array();
  for (const StandingFoot* foot : {&left, &right}) {
    for (const std::size_t joint : foot->bearing) joints.push_back(model.joints[joint].name);
  }
  const double mgh = 9.81 * model.mass_kg() * stance.com_m;
  const double toe_m = std::min(left.toe_m, right.toe_m), heel_m = std::min(left.heel_m, right.heel_m);
  return {{"name", "balance"},
          {"doc", "E: scaled by the robot's weight and height."},
          {"type", "stance"},
          {"joints", joints},
          {"options", {{"left_foot", model.links[left.link].name}, {"right_foot", model.links[right.link].name}}},
          {"parameters",
           {{"share", 1},
            {"pull_x", 6},
            {"pull_y", 2},
            {"toe_m", rounded(std::max(0.0, toe_m - edge_m))},
            {"heel_m", rounded(std::max(0.0, heel_m - edge_m))},
            {"side_m", 0.02},
            {"sole_m", rounded(std::max(0.0, std::max(left.below_m, right.below_m)))},
            {"upright_Nm_per_rad", figures(std::min(most_Nm_per_rad, 2 * mgh))},
            {"upright_Nms_per_rad", figures(std::min(most_Nms_per_rad, 0.2 * mgh))},
            {"level_Nm_per_rad", figures(std::min(most_Nm_per_rad, mgh))},
            {"level_Nms_per_rad", figures(std::min(most_Nms_per_rad, 0.1 * mgh))},
            {"height_m", 0},
            {"smooth_s", 0.004}}}};
}

// Three legs or more share the weight and what rights the trunk. The gains were found on quadrupeds of many makers
// (docs/own_robot.md).
Json support_json(const RobotModel& model, const StandingPose& stance) {
  double height_m = stance.com_m;  // over the ground, not over frames of feet that lie at the knees
  for (const StandingFoot& foot : stance.feet) height_m += foot.below_m / static_cast<double>(stance.feet.size());
  constexpr double most_Nm_per_rad = 5000, most_Nms_per_rad = 500;
  const double mgh = 9.81 * model.mass_kg() * height_m;
  Json joints = Json::array();
  Json parameters = {{"share", 1},
                     {"pull", 4},
                     {"upright_Nm_per_rad", figures(std::min(most_Nm_per_rad, 0.8 * mgh))},
                     {"upright_Nms_per_rad", figures(std::min(most_Nms_per_rad, 0.08 * mgh))},
                     {"level_Nm_per_rad", figures(std::min(most_Nm_per_rad, 0.8 * mgh))},
                     {"level_Nms_per_rad", figures(std::min(most_Nms_per_rad, 0.08 * mgh))},
                     {"turn_Nms_per_rad", figures(std::min(most_Nms_per_rad, 0.04 * mgh))},
                     {"smooth_s", 0.004}};
  std::string links;
  for (const StandingFoot& foot : stance.feet) {
    const std::string& link = model.links[foot.link].name;
    links += (links.empty() ? "" : " ") + link;
    for (const std::size_t joint : foot.leg) {
      if (!model.joints[joint].passive()) joints.push_back(model.joints[joint].name);
    }
    constexpr std::array<const char*, 3> axes{"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k) {
      double middle_m = 0;
      for (const Vec3& corner_m : foot.corners_m) middle_m += corner_m[k] / static_cast<double>(foot.corners_m.size());
      parameters[link + "." + axes[k] + "_m"] = rounded(middle_m);
    }
  }
  return {{"name", "balance"},
          {"doc", "E: scaled by the robot's weight and height."},
          {"type", "support_forces"},
          {"joints", joints},
          {"options", {{"feet", links}}},
          {"parameters", parameters}};
}

// The motors of what hangs from the base: all of a robot that is held, else those that are in no leg.
Json hanging_joints(const RobotModel& model, const StandingPose& stance, const Json& motors) {
  Json hanging = motors;
  for (const StandingFoot& foot : stance.stands_on()) {
    for (const std::size_t joint : foot.leg) std::erase(hanging.get_ref<Json::array_t&>(), model.joints[joint].name);
  }
  return hanging;
}

bool balances(const StandingPose& stance, std::size_t joint) {
  return stance.stands_on().size() == 2 && std::ranges::any_of(stance.feet, [joint](const StandingFoot& foot) {
           return std::ranges::find(foot.bearing, joint) != foot.bearing.end();
         });
}

// Of the loop in a wheel's drive: a tenth of its top speed off asks for its whole torque. Many files give no top speed.
double wheel_gain(const Joint& joint) {
  constexpr double most_Nms_per_rad = 1e4, share = 0.1, usual_rad_s = 20;
  return std::min(most_Nms_per_rad,
                  joint.effort_max_Nm / (share * std::clamp(joint.velocity_max_rad_s, 0.1, usual_rad_s)));
}

// The behavior that rolls a robot on wheels.
std::string roll_text(const RobotModel& model, const StandingPose& stance) {
  double most_rad_s = 100;
  std::string wheels;
  for (const StandingWheel& wheel : stance.wheels) {
    const Joint& joint = model.joints[wheel.joint];
    most_rad_s = std::min(most_rad_s, 0.8 * joint.velocity_max_rad_s);
    wheels += (wheels.empty() ? "" : ", ") + ("{ name = " + source_text(joint.name) + ", forward = ") +
              number_text(wheel.forward) + " }";
  }
  return filled_template(roll_template, {{"@rate@", number_text(figures(std::min(4.0, 0.5 * most_rad_s)))},
                                         {"@most@", number_text(figures(most_rad_s))},
                                         {"@wheels@", wheels}});
}

Json robot_json(const RobotDescription& robot, const std::string& name, const StandingPose& stance,
                const std::vector<JointHold>& holds) {
  const RobotModel& model = robot.model;
  const bool bolted = stance.held;
  Json drives = {{"doc",
                  "E: estimates, to be replaced by what the maker says. A rotor that the motor's whole torque brings "
                  "to 2500 rad/s2, unless the URDF has it."}};
  Json parameters = Json::object(), motors = Json::array(), wheels = Json::array();
  const std::vector<std::string> drive_names = model.drive_names();
  for (std::size_t i = 0; i < holds.size(); ++i) {
    const std::string& joint = model.joints[i].name;
    if (!(holds[i].stiffness_Nm_per_rad > 0)) continue;
    Json& drive = drives[drive_names[i]] = {{"rotor_inertia_kg_m2", figures(holds[i].rotor_inertia_kg_m2)}};
    if (stance.is_wheel(i)) {
      wheels.push_back(joint);
      drive["velocity_gain_Nms_per_rad"] = figures(wheel_gain(model.joints[i]));
      continue;
    }
    motors.push_back(joint);
    if (model.coupling_of(i) == nullptr) {  // of the drive's own modes; a coupled drive is seen from its own side
      drive["position_gain_Nm_per_rad"] = figures(holds[i].stiffness_Nm_per_rad);
      drive["velocity_gain_Nms_per_rad"] = figures(holds[i].damping_Nms_per_rad);
    }
    parameters[joint + ".kp_Nm_per_rad"] = figures(holds[i].stiffness_Nm_per_rad);
    parameters[joint + ".kd_Nms_per_rad"] = figures(holds[i].damping_Nms_per_rad);
    // What a weak ankle can give is the balance's, which takes up to nine tenths; both together stay within its limit.
    if (holds[i].weak && balances(stance, i))
      parameters[joint + ".effort_max_Nm"] = figures(0.1 * model.joints[i].effort_max_Nm);
  }
  Json objects = Json::array(), hold = {{"doc", "Holds its joints."}, {"objects", Json::array()}};
  const auto put = [&](Json object) {
    hold["objects"].push_back(object["name"]);
    objects.push_back(std::move(object));
  };
  if (!motors.empty())
    put({{"name", "posture"},
         {"doc",
          "Each joint is stiffer than gravity pulls it away (three times where it can be), at most half of "
          "what two ticks of delay allow, and damped at most half of that."},
         {"type", "joint_pid"},
         {"joints", motors},
         {"parameters", parameters}});
  const auto sum_up = [&](const Json& object, const char* doc) {
    put(object);
    hold["doc"] = doc;
    hold["sum"].push_back(object["name"]);
  };
  if (const Json hanging = hanging_joints(model, stance, motors); !hanging.empty())
    sum_up({{"name", "weight"},
            {"type", "gravity_compensation"},
            {"joints", hanging},
            {"options", {{"from_off", "at_once"}}}},
           "Holds its joints, and carries the weight of what hangs.");
  if (stance.stands_on().size() == 2)
    sum_up(balance_json(model, stance), "Holds its joints, and keeps its centre of mass over its soles.");
  else if (stance.stands_on().size() > 2 && stance.feet.size() <= max_feet)
    sum_up(support_json(model, stance), "Holds its joints; its feet share the weight and what rights the trunk.");
  if (!wheels.empty()) {
    put({{"name", "wheels"}, {"type", "joint_velocity"}, {"joints", wheels}});
    hold["doc"] = "Holds its joints, and turns its wheels as fast as it is told.";
  }
  Json plant = {{"drives", drives}, {"fixed_base", bolted}, {"self_collision", true}};
  Json safety = Json::object();
  if (bolted) {
    safety = {{"sensors", {{"imu", false}}}};
  } else {
    plant["imu"] = {{"doc", "E."}, {"gyro_noise_rad_s", 0.005}, {"accelerometer_noise_m_s2", 0.05}};
    if (stance.feet.size() <= max_feet) plant["feet"] = feet_json(model, stance);
  }
  Json start = {{"pose", "stand"}};
  if (bolted) start = {{"pose", "stand"}, {"stand_on_ground", false}, {"position_m", {0, 0, rounded(stance.height_m)}}};
  return {{"name", name},
          {"doc", "Written by kadans new robot. E marks an estimate."},
          {"urdf", "models/" + name + "/" + name + ".urdf"},
          {"engine", {{"control_period_s", 0.001}, {"behavior_period_s", 0.01}}},
          {"poses", poses_json(robot, stance)},
          {"safe", {{"pose", "stand"}, {"after_s", 0.5}, {"time_s", 2}}},
          {"plant", plant},
          {"start", start},
          {"safety", safety},
          {"control", {{"objects", objects}, {"sets", {{"hold", hold}}}}}};
}

// How far its base may sink: of a base whose frame lies in the ground's height a little, so that it is seen to fall.
double least_fall_m(const StandingPose& stance) {
  return stance.height_m < 0.02 ? 0.01 : std::max(0.3 * stance.height_m, 0.02);
}

Json scenario_json(const std::string& name, const StandingPose& stance) {
  Json checks = Json::array();
  if (!stance.held) {
    checks.push_back({{"name", "stays up, lowest height in m"},
                      {"kind", "always"},
                      {"signal", "plant.base.height_m"},
                      {"min", rounded(stance.height_m - least_fall_m(stance), 1e-3)}});
    checks.push_back({{"name", "upright, rad"}, {"kind", "always"}, {"signal", "plant.base.tilt_rad"}, {"max", 0.3}});
  }
  // The model's motors never give more than they can; those that give all they can hold nothing.
  checks.push_back({{"name", "no motor at its limit at the end"},
                    {"kind", "at_end"},
                    {"that", "plant.limits.motor_torque_share < 1"}});
  // The gear of a rotor bears what turns the rotor, too: more than the motor gives when the feet come down.
  checks.push_back(
      {{"name", "gears, in impacts too"}, {"kind", "always"}, {"that", "plant.limits.torque_share <= 1.5"}});
  checks.push_back({{"name", "at rest at the end"}, {"kind", "at_end"}, {"that", "plant.limits.speed_share <= 0.1"}});
  checks.push_back({{"name", "no faults"}, {"kind", "always"}, {"signal", "safety.faults"}, {"max", 0}});
  return {{"name", name + "_hold"},
          {"doc", stance.held ? "Held for ten seconds." : "Stands for ten seconds."},
          {"robot", "config/" + name + "/robot.json"},
          {"duration_s", 10},
          {"checks", checks}};
}

// The joint without a motor on which all others with one hang; "": there is none.
std::string loose_root(const RobotModel& model) {
  std::size_t first = 0;
  while (first < model.joints.size() && model.joints[first].passive()) ++first;
  for (std::size_t i = 0; i < first && first < model.joints.size(); ++i) {
    const auto hangs = [&](std::size_t joint) {
      for (std::size_t link = model.joints[joint].parent; link > 0; link = model.joints[link - 1].parent) {
        if (link - 1 == i) return true;
      }
      return false;
    };
    bool all = true;
    for (std::size_t joint = first; joint < model.joints.size(); ++joint)
      all = all && (model.joints[joint].passive() || hangs(joint));
    if (all) return model.joints[i].name;
  }
  return "";
}

void tell(const RobotModel& model, const StandingPose& stance, const std::vector<JointHold>& holds) {
  std::fprintf(stderr, "%zu joints, %.3g kg\n", model.joints.size(), model.mass_kg());
  if (!stance.wheels.empty()) {
    const std::string wheels =
        listed(stance.wheels, [&](const StandingWheel& wheel) { return model.links[wheel.joint + 1].name; });
    std::fprintf(stderr, "It rolls on %s, its base %.3g m high.\n", wheels.c_str(), stance.height_m);
  } else if (stance.feet.empty()) {
    std::fprintf(stderr, "It is bolted down (plant.fixed_base): %s.\n", stance.why_held.c_str());
    if (const std::string loose = loose_root(model); !loose.empty())
      std::fprintf(stderr, "warning: joint %s has no motor, and carries all that have one: gravity may take it\n",
                   loose.c_str());
  } else if (stance.held) {
    std::fprintf(stderr,
                 "Its soles are %.0f mm wide together: it does not stand without stepping, so it is bolted down "
                 "(plant.fixed_base).\n",
                 1000 * stance.width_m);
  } else {
    const std::string feet = listed(stance.feet, [&](const StandingFoot& foot) { return model.links[foot.link].name; });
    std::fprintf(stderr, "It stands on %s, its base %.3g m high.\n", feet.c_str(), stance.height_m);
  }
  for (std::size_t i = 0; i < holds.size(); ++i) {
    if (holds[i].weak)
      std::fprintf(stderr,
                   "warning: %s can hardly be held: gravity takes %.3g Nm/rad, and the delay allows %.3g Nm/rad\n",
                   model.joints[i].name.c_str(), holds[i].load_Nm_per_rad, holds[i].stiffness_Nm_per_rad);
  }
}

// Runs the scenario, and leaves its record and a picture of its end beside the URDF. The exit code of the run.
int run_and_draw(const fs::path& scenario, const fs::path& picture) {
  const std::string record = fs::absolute(picture).replace_extension(".mcap").string();
  const int code = run_kadans({"sim", fs::absolute(scenario).string(), "--record", record});
  if (code == exit_passed || code == exit_failed) {
    const std::string missing = pictures_missing();
    if (!missing.empty()) std::fprintf(stderr, "No picture: %s\n", missing.c_str());
    if (missing.empty()) (void)run_kadans({"render", record, "--at", "10", "-o", picture.string()});
  }
  return code;
}

int run_new_robot(const NewRobotOptions& options) {
  const UrdfPackages packages = packages_of(options.packages);
  std::vector<InputProblem> warnings;
  const RobotDescription description = read_robot_description(
      options.urdf, {.mesh_hull = mesh_hull, .mesh_triangles = mesh_triangles, .packages = packages}, &warnings);
  const RobotModel& model = description.model;
  const std::string name = options.name.empty() ? name_from(model.name) : options.name;
  if (name.empty() || name != name_from(name))
    refuse(options.urdf, "'" + (options.name.empty() ? model.name : options.name) +
                             "': a robot's name is words of a-z and 0-9 joined by _: --name NAME");
  const fs::path project = options.folder;
  const fs::path models = project / "models" / name, config = project / "config" / name,
                 behaviors = project / "behaviors" / name,
                 scenario = project / "config" / "scenarios" / (name + "_hold.json");
  if (!options.srdf.empty()) {
    std::vector<InputProblem> odd;
    (void)read_srdf(options.srdf, model, &odd);
    warnings.insert(warnings.end(), odd.begin(), odd.end());
  }
  const StandingPose stance = find_stance(model);
  const std::vector<JointHold> holds = hold_joints(model, stance);
  if (std::ranges::none_of(holds, [](const JointHold& hold) { return hold.stiffness_Nm_per_rad > 0; }))
    refuse(options.urdf,
           "no joint of it has a motor: <limit effort=...> says which torque it has, an MJCF's <actuator>");

  Json robot = robot_json(description, name, stance, holds);
  const std::string srdf = options.srdf.empty() ? touching_srdf(model, name, stance) : read_input_file(options.srdf);
  if (!srdf.empty()) robot["plant"]["srdf"] = "models/" + name + "/" + name + ".srdf";
  std::map<std::string, std::string> meshes;
  const std::string own = with_own_meshes(description.urdf, options.urdf, packages, meshes);
  std::vector<NewFile> files{{models / (name + ".urdf"), own},
                             {config / "robot.json", json_text(robot, 2) + "\n"},
                             {scenario, json_text(scenario_json(name, stance), 2) + "\n"}};
  const auto add_behavior = [&](const std::string& behavior, std::string text) {
    files.push_back({behaviors / (behavior + ".lua"), std::move(text)});
    files.push_back({behaviors / (behavior + "_test.lua"),
                     filled_template(motion_test_template, {{"@name@", name}, {"@behavior@", behavior}})});
  };
  const bool rolls = !stance.wheels.empty();
  if (rolls) add_behavior("roll", roll_text(model, stance));
  if (robot["control"]["objects"].front()["name"] == "posture") add_behavior("sway", std::string(sway_template));
  if (!srdf.empty()) files.push_back({models / (name + ".srdf"), srdf});
  write_new_files({models, config, behaviors, scenario}, files);
  for (const auto& [from, to] : meshes) {
    std::error_code error;
    fs::create_directories(models / "meshes", error);
    fs::copy_file(from, models / "meshes" / to, error);
    if (error) refuse(from, "cannot be copied: " + error.message());
  }
  std::fflush(stdout);
  for (const InputProblem& warning : warnings) std::fprintf(stderr, "warning: %s\n", warning.text().c_str());
  tell(model, stance, holds);
  const std::string shown = shell_word(fs::relative(scenario, project).string());
  const std::string at = project == "." ? "" : "cd " + shell_word(project.string()) + " && ";
  std::fprintf(stderr, "Run it:  %skadans sim %s    with the behavior: --play %s\n", at.c_str(), shown.c_str(),
               rolls ? "roll" : "sway");
  if (options.no_run) return exit_passed;
  return run_and_draw(scenario, models / (name + ".png"));
}

}  // namespace

void add_new_robot(CLI::App& made, CommandLine& line) {
  const auto [robot, options] = line.add<NewRobotOptions>(
      made, "robot", "Write the files of a robot from its URDF or MJCF, and see it stand", run_new_robot);
  robot->add_option("urdf", options.urdf, "URDF, xacro or MJCF of the robot")->required()->type_name("FILE");
  robot->add_option("--srdf", options.srdf, "SRDF of the robot: its pairs of links pass through each other")
      ->type_name("FILE");
  robot->add_option("--package", options.packages, package_help)->type_name("NAME=FOLDER")->allow_extra_args(false);
  robot->add_option("--name", options.name, "Its name, words of a-z and 0-9 joined by _ (default: that of the file)")
      ->type_name("NAME");
  robot->add_option("--in", options.folder, "Project to which its files are added (default: this folder)")
      ->type_name("FOLDER");
  robot->add_flag("--no-run", options.no_run, "Do not run its scenario");
}

}  // namespace kadans
