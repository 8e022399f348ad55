// dcm_walk on humanoids of another size than TULip's, without a parameter of the walk: its numbers come from the model.
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <utility>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace other_humanoid_test {

using namespace kadans::program;
using nlohmann::json;

namespace {

// Every number of this attribute, times the factor.
void scale_attribute(std::string& urdf, const std::string& attribute, double factor) {
  const std::string begin = " " + attribute + "=\"";
  for (std::size_t at = urdf.find(begin); at != std::string::npos; at = urdf.find(begin, at + 1)) {
    const std::size_t from = at + begin.size(), to = urdf.find('"', from);
    std::istringstream in(urdf.substr(from, to - from));
    std::ostringstream out;
    out.precision(12);
    for (double value = 0; in >> value;) out << (out.str().empty() ? "" : " ") << factor * value;
    urdf.replace(from, to - from, out.str());
  }
}

void rename(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

// TULip, all its lengths this many times as long, of the same materials, with torques for its weight and joints of
// other names.
std::string humanoid(std::string urdf, double s) {
  rename(urdf, "<mass value", "<mass kg");
  for (const auto& [attribute, factor] : {std::pair{"xyz", s},
                                          {"size", s},
                                          {"radius", s},
                                          {"length", s},
                                          {"kg", std::pow(s, 3)},
                                          {"effort", std::pow(s, 4)},
                                          {"velocity", 1 / std::sqrt(s)},
                                          {"ixx", std::pow(s, 5)},
                                          {"iyy", std::pow(s, 5)},
                                          {"izz", std::pow(s, 5)}})
    scale_attribute(urdf, attribute, factor);
  for (const char* axis : {"1 0 0", "0 1 0", "0 0 1"}) {  // of unit length, as before
    std::istringstream in(axis);
    std::ostringstream scaled;
    scaled.precision(12);
    for (double value = 0; in >> value;) scaled << (scaled.str().empty() ? "" : " ") << s * value;
    rename(urdf, "<axis xyz=\"" + scaled.str(), std::string("<axis xyz=\"") + axis);
  }
  rename(urdf, "<mass kg", "<mass value");
  for (const auto& [from, to] : {std::pair{"hip_", "thigh_"}, {"knee", "shin"}, {"ankle_", "foot_"}})
    rename(urdf, from, to);
  return urdf;
}

json robot(double s) {
  const double torque = std::pow(s, 4), time = std::sqrt(s);
  json robot;
  robot["name"] = "other";
  robot["urdf"] = "models/other.urdf";
  robot["poses"]["set_out"] = {{"*", 0}, {"*_thigh_pitch", -0.43}, {"*_shin", 0.86}, {"*_foot_pitch", -0.43}};
  robot["start"] = {{"pose", "set_out"}, {"stand_on_ground", true}};
  const auto foot = [&](const char* link, double inner) {
    const auto corner = [&](double x, double y) { return json{s * x, s * y, -0.06 * s}; };
    return json{{"link", link},
                {"heel_inner_m", corner(-0.08, inner)},
                {"heel_outer_m", corner(-0.08, -inner)},
                {"toe_inner_m", corner(0.14, inner)},
                {"toe_outer_m", corner(0.14, -inner)}};
  };
  robot["plant"]["feet"] = {foot("l_foot_roll_link", -0.05), foot("r_foot_roll_link", 0.05)};
  robot["plant"]["drives"]["*"] = {{"rotor_inertia_kg_m2", 0.02 * std::pow(s, 5)},
                                   {"viscous_Nms_per_rad", 0.2 * torque * time},
                                   {"spring_Nm_per_rad", 3000 * torque},
                                   {"spring_damping_Nms_per_rad", torque * time}};
  robot["plant"]["drives"]["*_foot_roll"] = {{"rotor_inertia_kg_m2", 0},
                                             {"viscous_Nms_per_rad", 0},
                                             {"spring_Nm_per_rad", 0},
                                             {"spring_damping_Nms_per_rad", 0},
                                             {"parallel_spring_Nm_per_rad", 25 * torque},
                                             {"parallel_damping_Nms_per_rad", 0.6 * torque * time}};
  const json gains{{"*.kp_Nm_per_rad", 300 * torque}, {"*.kd_Nms_per_rad", 4 * torque * time}};
  robot["control"]["objects"] = {
      {{"name", "posture"},
       {"type", "joint_pid"},
       {"joints", {"*"}},
       {"parameters", gains},
       {"presets", {{"stiff", gains}}}},
      {{"name", "walk"},
       {"type", "dcm_walk"},
       {"joints", {"*_thigh_yaw", "*_thigh_roll", "*_thigh_pitch", "*_shin", "*_foot_pitch"}},
       {"options", {{"left_foot", "l_foot_roll_link"}, {"right_foot", "r_foot_roll_link"}}}}};
  robot["control"]["sets"]["walking"] = {{"objects", {"posture", "walk"}}, {"priority", {"walk"}}};
  robot["control"]["initial_set"] = "walking";
  return robot;
}

constexpr const char* walks = R"(local k = require "kadans"
local walk = require "walking"
local P = k.params { forward_m_s = { 0, min = 0, max = 2, unit = "m/s", doc = "velocity forward" } }
return k.behavior "walks" {
  controls = "walking",
  initial = "go",
  k.state "go" {
    endless = true,
    run = function(m)
      walk.set_out(m, 0.8)
      walk.go(m, { forward_m_s = P.forward_m_s })
      m:wait(1000)
    end,
  },
}
)";

}  // namespace

TEST_CASE("A humanoid of another size and with other names walks by what its model says of it") {
  for (const double s : {0.7, 1.5}) {
    CAPTURE(s);
    const auto project = project_copy("other_humanoid");
    const double m_s = 0.3 * std::sqrt(s), walks_s = 10;
    write(project / "models/other.urdf", humanoid(read(project / "models/tulip/tulip.urdf"), s));
    write(project / "config/tulip/other.json", robot(s).dump(1));
    write(project / "behaviors/tulip/walks.lua", walks);
    json scenario;
    scenario["name"] = "other_walks";
    scenario["robot"] = "config/tulip/other.json";
    scenario["duration_s"] = walks_s + 1;
    scenario["start_pose"] = "set_out";
    scenario["behaviors"] = {"walks{forward_m_s=" + std::to_string(m_s) + "}"};
    scenario["checks"] = {{{"name", "stays up"}, {"kind", "always"}, {"that", "plant.base.tilt_rad < 0.4"}},
                          {{"name", "walks"},
                           {"kind", "at_end"},
                           {"signal", "plant.base.x_m"},
                           {"min", 0.8 * m_s * walks_s},
                           {"max", 1.2 * m_s * walks_s}}};
    write(project / "config/scenarios/other_walks.json", scenario.dump(1));
    const Outcome sim = run("sim config/scenarios/other_walks.json --no-record", project);
    CHECK_MESSAGE(sim.exit_code == 0, sim.out, sim.err);
  }
}

}  // namespace other_humanoid_test
